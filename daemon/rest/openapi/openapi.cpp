#include "daemon/rest/openapi/openapi.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "daemon/rest/openapi/error_schema.h"
#include "daemon/rest/openapi/extra_routes.h"
#include "daemon/rest/openapi/schemas.h"
#include "daemon/rest/routes.h"
#include "daemon/rest/security.h"
#include "daemon/rest/sequence.h"
#include "hydroprint/v1/access.pb.h"
#include "proto/rules/comments.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using Json = nlohmann::ordered_json;

// A path in the notation of the document: "/jobs/{job}/artifacts/{artifact}". OpenAPI allows only
// parameters of one segment; each is named after the literal before it.
struct ShownPath {
  std::string text;
  Json parameters = Json::array();
};

std::string singular(const std::string& word) {
  return word.size() > 1 && word.back() == 's' ? word.substr(0, word.size() - 1) : word;
}

Json path_parameter(const std::string& name, const std::string& description) {
  Json parameter = {{"name", name}, {"in", "path"}, {"required", true}};
  if (!description.empty()) parameter["description"] = description;
  parameter["schema"] = {{"type", "string"}};
  return parameter;
}

// Returns the comment on the field whose value contains segment `at`; empty if there is none.
std::string comment_at(const Route& route, std::size_t at) {
  for (std::size_t i = 0; i < route.path.variables.size(); ++i) {
    const Variable& variable = route.path.variables[i];
    if (at >= variable.begin && at < variable.end) {
      return fmt::format("Part of `{}`: {}", path_text(route.path_fields[i]),
                         rules::comment_on(route.path_fields[i].back()->full_name()));
    }
  }
  return {};
}

ShownPath shown(const Route& route) {
  ShownPath path;
  std::string before = "id";
  for (std::size_t i = 0; i < route.path.segments.size(); ++i) {
    const Segment& segment = route.path.segments[i];
    if (segment.kind == Segment::Kind::kLiteral) {
      path.text += "/" + segment.literal;
      before = singular(segment.literal);
    } else {
      path.text += "/{" + before + "}";
      path.parameters.push_back(path_parameter(before, comment_at(route, i)));
    }
  }
  if (!route.path.verb.empty()) path.text += ":" + route.path.verb;
  return path;
}

class Document {
 public:
  explicit Document(const std::vector<Route>& routes) {
    document_ = {
        {"openapi", "3.0.3"},
        {"info",
         {{"title", "Hydroprint"},
          {"description", "Computational hydrographic printing: jobs, their files, and the rig."},
          {"license", {{"name", "GPL-3.0-or-later"}}},
          {"version", HYDROPRINT_VERSION}}},
        {"servers", Json::array({{{"url", "/"}}})},
        {"tags", Json::array()},
        {"paths", Json::object()}};
    for (const Route& route : routes) schemas_.expect_answer(*route.method->output_type());
    schemas_.add("Error", error_schema(schemas_));
  }

  Status add(const Route& route) {
    const pb::MethodDescriptor& method = *route.method;
    const std::string comment = rules::comment_on(method.full_name());
    Json operation = {{"operationId", method.name()},
                      {"tags", Json::array({method.service()->name()})},
                      {"summary", rules::first_sentence(comment)},
                      {"description", comment}};
    ShownPath path = shown(route);
    add_query(route, path.parameters);
    if (method.server_streaming() && is_resumable(method)) path.parameters.push_back(last_event());
    if (!path.parameters.empty()) operation["parameters"] = std::move(path.parameters);
    if (route.body != Body::kNone) operation["requestBody"] = body_of(route);
    operation["responses"] = {{"200", answer_of(method)}, {"default", error_answer()}};
    const bool is_open = method.options().GetExtension(v1::without_sign_in);
    operation["security"] = security_of(is_open, route.http_method);
    add_tag(method.service()->name(), rules::comment_on(method.service()->full_name()));
    return place(path.text, route.http_method, method.name(), std::move(operation));
  }

  Status add(const OtherRoute& route) {
    Json operation = {{"operationId", route.operation},
                      {"tags", Json::array({route.tag})},
                      {"summary", route.summary}};
    if (!route.description.empty()) operation["description"] = route.description;
    for (const OtherParameter& parameter : route.parameters) {
      operation["parameters"].push_back({{"name", parameter.name},
                                         {"in", parameter.in},
                                         {"required", parameter.required},
                                         {"description", parameter.description},
                                         {"schema", {{"type", parameter.type}}}});
    }
    if (!route.content_type.empty()) {
      operation["requestBody"] = {{"required", true}, {"content", content(route.content_type)}};
    }
    for (const OtherAnswer& answer : route.answers) {
      operation["responses"][std::to_string(answer.status)] = answer_of(answer);
    }
    operation["responses"]["default"] = error_answer();
    operation["security"] = security_of(route.is_open, route.http_method);
    add_tag(route.tag, route.tag == "Daemon" ? "The daemon itself." : "");
    return place(route.path, route.http_method, route.operation, std::move(operation));
  }

  std::string text() {
    document_["components"] = {{"schemas", schemas_.all()},
                               {"responses", {{"Error", error_response()}}},
                               {"securitySchemes", security_schemes()}};
    return document_.dump(1) + "\n";
  }

 private:
  static Json error_answer() { return {{"$ref", "#/components/responses/Error"}}; }

  static Json error_response() {
    return {{"description", "An error."},
            {"content",
             {{"application/json", {{"schema", {{"$ref", "#/components/schemas/Error"}}}}}}}};
  }

  static Json last_event() {
    return {{"name", "Last-Event-ID"},
            {"in", "header"},
            {"description",
             "The last `id` received, as EventSource sends it; takes precedence over\n"
             "`afterSeq`."},
            {"schema", {{"type", "string"}, {"format", "int64"}}}};
  }

  static Json content(const std::string& type) {
    const bool is_text = type == "text/plain";
    const Json schema = type == "application/json" ? Json{{"type", "object"}}
                        : is_text                  ? Json{{"type", "string"}}
                                                   : Json{{"type", "string"}, {"format", "binary"}};
    return {{type, {{"schema", schema}}}};
  }

  void add_query(const Route& route, Json& parameters) {
    if (route.body == Body::kAll) return;
    std::vector<const pb::Descriptor*> inside;
    add_fields(*route.method->input_type(), {}, route, inside, parameters);
  }

  // Adds the fields of a message that go into the query, including nested ones ("a.b").
  void add_fields(const pb::Descriptor& message, const FieldPath& before, const Route& route,
                  std::vector<const pb::Descriptor*>& inside, Json& parameters) {
    if (std::count(inside.begin(), inside.end(), &message) > 0) return;
    inside.push_back(&message);
    for (int i = 0; i < message.field_count(); ++i) {
      const pb::FieldDescriptor& field = *message.field(i);
      FieldPath path = before;
      path.push_back(&field);
      const bool is_bound =
          std::count(route.path_fields.begin(), route.path_fields.end(), path) > 0;
      if (is_bound || (before.empty() && &field == route.body_field)) continue;
      if (field.message_type() == nullptr || is_written_as_value(field)) {
        parameters.push_back(in_query(path));
      } else if (!field.is_repeated()) {
        add_fields(*field.message_type(), path, route, inside, parameters);
      }
    }
    inside.pop_back();
  }

  Json in_query(const FieldPath& path) {
    std::string name;
    for (const auto* field : path) name += (name.empty() ? "" : ".") + field->json_name();
    Json schema = schemas_.of_field(*path.back(), Way::kSent);
    schema.erase("description");
    // Unwraps a reference that described() has put into allOf.
    if (schema.contains("allOf")) schema = Json(schema["allOf"][0]);
    Json parameter = {{"name", name}, {"in", "query"}};
    const std::string description = description_of(*path.back());
    if (!description.empty()) parameter["description"] = description;
    parameter["schema"] = std::move(schema);
    return parameter;
  }

  Json body_of(const Route& route) {
    const pb::Descriptor& request = *route.method->input_type();
    Json body = Json::object();
    Json schema;
    if (route.body == Body::kField) {
      body["description"] = rules::comment_on(route.body_field->full_name());
      schema = schemas_.reference(*route.body_field->message_type(), Way::kSent);
    } else if (route.path_fields.empty()) {
      schema = schemas_.reference(request, Way::kSent);
    } else {
      std::set<std::string> bound;
      for (const FieldPath& path : route.path_fields) {
        if (path.size() == 1) bound.insert(path[0]->name());
      }
      schema = schemas_.reference_without(request, bound);
    }
    if (schemas_.at(schema).contains("required")) body["required"] = true;
    body["content"] = {{"application/json", {{"schema", std::move(schema)}}}};
    return body;
  }

  Json answer_of(const pb::MethodDescriptor& method) {
    Json schema = schemas_.reference(*method.output_type(), Way::kAnswered);
    if (method.options().HasExtension(v1::raw_answer)) {
      const v1::RawAnswer& raw = method.options().GetExtension(v1::raw_answer);
      const std::string before =
          raw.with_other_fields()
              ? " as JSON on a line with a multiple of 8 bytes, then the bytes of `"
              : ": the bytes of `";
      return {{"description", method.output_type()->name() + before + raw.field() + "`."},
              {"content", content(raw.media_type())},
              {"x-message", std::move(schema)}};
    }
    if (!method.server_streaming()) {
      return {{"description", "Done."},
              {"content", {{"application/json", {{"schema", std::move(schema)}}}}}};
    }
    std::string description =
        "Server-sent events; the `data` of each event is one message of this schema. An event\n"
        "`end` means that no more events follow. If an error occurs after the stream has begun,\n"
        "an event `error` with an Error ends the stream.";
    if (is_resumable(method)) description += " The `id` of each event is the `seq` of its message.";
    return {{"description", std::move(description)},
            {"content", {{"text/event-stream", {{"schema", std::move(schema)}}}}}};
  }

  Json answer_of(const OtherAnswer& answer) {
    Json result = {{"description", answer.description}};
    for (const OtherParameter& header : answer.headers) {
      result["headers"][header.name] = {{"description", header.description},
                                        {"schema", {{"type", header.type}}}};
    }
    if (answer.content_type.empty()) return result;
    result["content"] = content(answer.content_type);
    const auto* message =
        pb::DescriptorPool::generated_pool()->FindMessageTypeByName(answer.schema);
    if (message != nullptr) {
      result["content"][answer.content_type]["schema"] =
          schemas_.reference(*message, Way::kAnswered);
    }
    return result;
  }

  void add_tag(const std::string& name, const std::string& description) {
    if (!tags_.insert(name).second) return;
    document_["tags"].push_back({{"name", name}, {"description", description}});
  }

  Status place(const std::string& path, std::string http_method, const std::string& name,
               Json operation) {
    for (char& c : http_method) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!operations_.insert(name).second) {
      return fail(Code::kInternal, "two operations are named " + name);
    }
    Json& at = document_["paths"][path][http_method];
    if (!at.is_null()) return fail(Code::kInternal, http_method + " " + path + " occurs twice");
    at = std::move(operation);
    return {};
  }

  Json document_;
  Schemas schemas_;
  std::set<std::string> tags_;
  std::set<std::string> operations_;
};

}  // namespace

Result<std::string> openapi() {
  HP_ASSIGN_OR_RETURN(const std::vector<Route> routes, read_routes(api_services()));
  Document document(routes);
  for (const Route& route : routes) {
    HP_RETURN_IF_ERROR(document.add(route));
  }
  for (const OtherRoute& route : other_routes()) {
    HP_RETURN_IF_ERROR(document.add(route));
  }
  return document.text();
}

}  // namespace hydroprint::rest
