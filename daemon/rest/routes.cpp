#include "daemon/rest/routes.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <algorithm>
#include <set>
#include <utility>

#include "google/api/annotations.pb.h"
#include "hydroprint/v1/access.pb.h"
#include "proto/described.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using google::api::HttpRule;

tl::unexpected<Error> refuse(const pb::MethodDescriptor& method, const std::string& what) {
  return fail(Code::kInternal, method.full_name() + ", google.api.http: " + what);
}

// Returns the HTTP method and the path template of a rule; the HTTP method is empty if the
// rule has none.
std::pair<std::string, std::string> pattern_of(const HttpRule& rule) {
  switch (rule.pattern_case()) {
    case HttpRule::kGet:
      return {"GET", rule.get()};
    case HttpRule::kPut:
      return {"PUT", rule.put()};
    case HttpRule::kPost:
      return {"POST", rule.post()};
    case HttpRule::kDelete:
      return {"DELETE", rule.delete_()};
    case HttpRule::kPatch:
      return {"PATCH", rule.patch()};
    default:
      return {};
  }
}

// Returns whether a message can contain arbitrary data. Reading such messages from JSON takes time
// quadratic in the size of the text, or worse.
bool holds_anything(const pb::Descriptor& message, std::set<const pb::Descriptor*>& seen) {
  static const std::set<std::string> kAnything = {"google.protobuf.Any", "google.protobuf.Struct",
                                                  "google.protobuf.Value",
                                                  "google.protobuf.ListValue"};
  if (!seen.insert(&message).second) return false;
  if (kAnything.count(message.full_name()) > 0) return true;
  for (int i = 0; i < message.field_count(); ++i) {
    const pb::Descriptor* inner = message.field(i)->message_type();
    if (inner != nullptr && holds_anything(*inner, seen)) return true;
  }
  return false;
}

Status check_method(const pb::MethodDescriptor& method) {
  if (method.client_streaming()) {
    return refuse(method, "client streaming is not possible over HTTP/1.1; remove the rule");
  }
  std::set<const pb::Descriptor*> seen;
  if (holds_anything(*method.input_type(), seen)) {
    return refuse(method, "the request contains Any, Struct, Value or ListValue");
  }
  return {};
}

Status read_path_fields(const pb::MethodDescriptor& method, Route& route) {
  for (const Variable& variable : route.path.variables) {
    const auto field = find_field(*method.input_type(), variable.field_path);
    if (!field) return refuse(method, variable.field_path + ": " + field.error().message);
    const pb::FieldDescriptor& last = *field->back();
    if (last.is_repeated() || last.message_type() != nullptr) {
      return refuse(method, variable.field_path + " must be one value, not a list or a message");
    }
    route.path_fields.push_back(*field);
  }
  return {};
}

Status read_body(const pb::MethodDescriptor& method, const std::string& body, Route& route) {
  if (body.empty()) return {};
  if (route.http_method == "GET" || route.http_method == "DELETE") {
    return refuse(method, route.http_method + " must not have a body");
  }
  route.body = body == "*" ? Body::kAll : Body::kField;
  if (route.body == Body::kAll) return {};
  route.body_field = method.input_type()->FindFieldByName(body);
  if (route.body_field == nullptr) return refuse(method, body + " is not a field of the request");
  const bool is_object = route.body_field->message_type() != nullptr &&
                         !route.body_field->is_repeated() &&
                         !is_written_as_value(*route.body_field);
  if (!is_object)
    return refuse(method, body + " must be a single message, which JSON writes as an object");
  for (const FieldPath& path : route.path_fields) {
    if (path.front() == route.body_field)
      return refuse(method, body + " is also bound by the path");
  }
  return {};
}

// Requires that the path contains all fields of a call that stops motion. Errors in a body or query
// could otherwise prevent the stop.
Status read_stop(const pb::MethodDescriptor& method, Route& route) {
  route.stops_motion = method.options().GetExtension(v1::stops_motion);
  if (!route.stops_motion) return {};
  for (int i = 0; i < method.input_type()->field_count(); ++i) {
    const pb::FieldDescriptor* field = method.input_type()->field(i);
    const auto& bound = route.path_fields;
    if (std::find(bound.begin(), bound.end(), FieldPath{field}) != bound.end()) continue;
    return refuse(method, "stops motion, so its path must contain the field " + field->name());
  }
  return {};
}

Result<Route> read_rule(const pb::MethodDescriptor& method, const HttpRule& rule) {
  Route route;
  route.method = &method;
  auto [http_method, path] = pattern_of(rule);
  if (http_method.empty()) return refuse(method, "the rule has no GET, PUT, POST, DELETE or PATCH");
  if (!rule.response_body().empty()) return refuse(method, "response_body is not supported");
  route.http_method = http_method;
  auto parsed = parse_template(path);
  if (!parsed) return refuse(method, parsed.error().message);
  route.path = *std::move(parsed);
  HP_RETURN_IF_ERROR(read_path_fields(method, route));
  HP_RETURN_IF_ERROR(read_body(method, rule.body(), route));
  HP_RETURN_IF_ERROR(read_stop(method, route));
  return route;
}

Status read_method(const pb::MethodDescriptor& method, std::vector<Route>& routes) {
  if (!method.options().HasExtension(google::api::http)) return {};
  HP_RETURN_IF_ERROR(check_method(method));
  const HttpRule& first = method.options().GetExtension(google::api::http);
  std::vector<const HttpRule*> rules = {&first};
  for (const HttpRule& rule : first.additional_bindings()) rules.push_back(&rule);
  for (const HttpRule* rule : rules) {
    HP_ASSIGN_OR_RETURN(Route route, read_rule(method, *rule));
    for (const Route& other : routes) {
      if (other.http_method == route.http_method && overlap(other.path, route.path)) {
        return refuse(method, "its path also matches requests for " + other.method->full_name());
      }
    }
    routes.push_back(std::move(route));
  }
  return {};
}

}  // namespace

const std::vector<std::string>& api_services() {
  static const std::vector<std::string> services = [] {
    std::vector<std::string> names;
    pb::FileDescriptorSet files;
    const std::string_view bytes = described_protos();
    if (!files.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return names;
    for (const pb::FileDescriptorProto& file : files.file()) {
      if (file.package() != "hydroprint.v1") continue;
      for (const auto& service : file.service()) {
        names.push_back(file.package() + "." + service.name());
      }
    }
    return names;
  }();
  return services;
}

std::string rpc_name(const pb::MethodDescriptor& method) {
  return "/" + method.service()->full_name() + "/" + method.name();
}

Result<std::vector<Route>> read_routes(const std::vector<std::string>& services) {
  if (services.empty()) return fail(Code::kInternal, "no services are given");
  std::vector<Route> routes;
  for (const std::string& name : services) {
    const auto* service = pb::DescriptorPool::generated_pool()->FindServiceByName(name);
    if (service == nullptr) return fail(Code::kInternal, "service " + name + " is not linked in");
    for (int i = 0; i < service->method_count(); ++i) {
      HP_RETURN_IF_ERROR(read_method(*service->method(i), routes));
    }
  }
  return routes;
}

const pb::FieldDescriptor* field_called(const pb::Descriptor& message, const std::string& name) {
  if (const auto* field = message.FindFieldByName(name)) return field;
  for (int i = 0; i < message.field_count(); ++i) {
    if (message.field(i)->json_name() == name) return message.field(i);
  }
  return nullptr;
}

Result<FieldPath> find_field(const pb::Descriptor& message, std::string_view path) {
  FieldPath found;
  const pb::Descriptor* inside = &message;
  for (bool more = true; more;) {
    const std::size_t dot = path.find('.');
    const std::string name(path.substr(0, dot));
    more = dot != std::string_view::npos;
    if (more) path.remove_prefix(dot + 1);
    const pb::FieldDescriptor* field = field_called(*inside, name);
    if (field == nullptr) {
      return fail(Code::kInvalidArgument, inside->name() + " has no such field");
    }
    found.push_back(field);
    if (found.size() > kMostLevels) {
      return fail(Code::kInvalidArgument, "is nested too deeply");
    }
    if (!more) break;
    if (field->message_type() == nullptr || field->is_repeated() || is_written_as_value(*field)) {
      return fail(Code::kInvalidArgument, field->name() + " has no fields that a URL can set");
    }
    inside = field->message_type();
  }
  return found;
}

std::string path_text(const FieldPath& path) {
  std::string text;
  for (const pb::FieldDescriptor* field : path) text += (text.empty() ? "" : ".") + field->name();
  return text;
}

bool is_written_as_value(const pb::FieldDescriptor& field) {
  static const std::set<std::string> kValues = {
      "Timestamp",  "Duration",    "FieldMask",  "BoolValue",   "StringValue", "BytesValue",
      "Int32Value", "UInt32Value", "Int64Value", "UInt64Value", "FloatValue",  "DoubleValue"};
  const pb::Descriptor* type = field.message_type();
  return type != nullptr && type->file()->package() == "google.protobuf" &&
         kValues.count(type->name()) > 0;
}

bool is_wrapper(const pb::FieldDescriptor& field) {
  if (!is_written_as_value(field)) return false;
  const pb::Descriptor& type = *field.message_type();
  return type.field_count() == 1 && type.field(0)->name() == "value";
}

}  // namespace hydroprint::rest
