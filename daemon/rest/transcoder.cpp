#include "daemon/rest/transcoder.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "daemon/rest/json_text.h"
#include "daemon/rest/percent.h"
#include "daemon/rest/query.h"
#include "daemon/rest/routes.h"
#include "daemon/rest/sequence.h"
#include "daemon/rest/values.h"
#include "hydroprint/v1/access.pb.h"
#include "proto/write_json.h"

namespace hydroprint::rest {
namespace {

namespace pb = google::protobuf;
using MessagePtr = std::unique_ptr<pb::Message>;

MessagePtr new_message(const pb::Descriptor& type) {
  return MessagePtr(pb::MessageFactory::generated_factory()->GetPrototype(&type)->New());
}

MessagePtr parsed(const pb::Descriptor& type, std::string_view bytes) {
  MessagePtr message = new_message(type);
  if (!message->ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return nullptr;
  return message;
}

// A route that matches the path, and the values of its variables.
struct Match {
  const Route* route = nullptr;
  std::vector<std::string> values;
};

bool has_value(const pb::Message& message, const FieldPath& path) {
  const pb::Message* inside = &message;
  for (const pb::FieldDescriptor* field : path) {
    if (!inside->GetReflection()->HasField(*inside, field)) return false;
    if (field != path.back()) inside = &inside->GetReflection()->GetMessage(*inside, field);
  }
  return true;
}

bool is_blank(std::string_view body) {
  return body.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

Status read_body(std::string_view body, const Route& route, pb::Message& request) {
  if (is_blank(body)) return {};
  if (route.body == Body::kNone) {
    // Some libraries send {} when there is no body.
    std::string rest(body);
    std::erase_if(rest, [](char c) { return is_blank({&c, 1}); });
    if (rest == "{}") return {};
    return fail(Code::kInvalidArgument,
                "request body: must be empty; put the parameters in the query",
                ErrorReason::JSON_INVALID);
  }
  if (route.body == Body::kField) {
    return read_json(body, *request.GetReflection()->MutableMessage(&request, route.body_field));
  }
  HP_RETURN_IF_ERROR(read_json(body, request));
  for (const FieldPath& path : route.path_fields) {
    if (!has_value(request, path)) continue;
    return fail_field(Code::kInvalidArgument, path_text(path),
                      "is already set by the path; leave it out", ErrorReason::JSON_INVALID);
  }
  return {};
}

std::vector<std::string> methods_of(const std::vector<Match>& matches) {
  std::vector<std::string> names;
  names.reserve(matches.size());
  for (const Match& match : matches) names.push_back(match.route->http_method);
  std::sort(names.begin(), names.end());
  return names;
}

tl::unexpected<Error> no_route(std::string_view http_method, std::string_view path,
                               const std::vector<Match>& matches) {
  if (matches.empty()) {
    return fail(Code::kNotFound, plain(path) + ": not found; see /openapi.json for all paths",
                ErrorReason::ROUTE_NOT_FOUND);
  }
  const std::string allowed = fmt::format("{}", fmt::join(methods_of(matches), ", "));
  auto error =
      fail(Code::kUnimplemented,
           fmt::format("{}: {} is not allowed; use {}", plain(path), plain(http_method), allowed),
           ErrorReason::METHOD_NOT_ALLOWED);
  error.value().metadata["allow"] = allowed;
  return error;
}

}  // namespace

struct Transcoder::Impl {
  std::vector<Route> routes;
  std::map<std::string, const pb::MethodDescriptor*, std::less<>> methods;

  // Returns all routes that match the path; the list may be empty.
  [[nodiscard]] Result<std::vector<Match>> matches(std::string_view path) const {
    HP_ASSIGN_OR_RETURN(const std::optional<Path> parts, split_path(path));
    std::vector<Match> found;
    if (!parts) return found;
    for (const Route& route : routes) {
      auto values = match(route.path, *parts);
      if (values) found.push_back({&route, *std::move(values)});
    }
    return found;
  }

  // Returns the route for a request.
  [[nodiscard]] Result<Match> match_of(std::string_view http_method, std::string_view path) const {
    HP_ASSIGN_OR_RETURN(std::vector<Match> found, matches(path));
    for (Match& match : found) {
      if (match.route->http_method == http_method) return std::move(match);
    }
    return no_route(http_method, path, found);
  }

  [[nodiscard]] const pb::MethodDescriptor* method(std::string_view name) const {
    const auto found = methods.find(name);
    return found == methods.end() ? nullptr : found->second;
  }
};

namespace {

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

std::string_view query_of(std::string_view target) {
  const std::size_t mark = target.find('?');
  return mark == std::string_view::npos ? std::string_view{} : target.substr(mark + 1);
}

}  // namespace

Result<Transcoder> Transcoder::make() { return make(api_services()); }

Result<Transcoder> Transcoder::make(const std::vector<std::string>& services) {
  auto impl = std::make_shared<Impl>();
  HP_ASSIGN_OR_RETURN(impl->routes, read_routes(services));
  for (const std::string& name : services) {
    const auto* service = pb::DescriptorPool::generated_pool()->FindServiceByName(name);
    for (int i = 0; i < service->method_count(); ++i) {
      impl->methods[rpc_name(*service->method(i))] = service->method(i);
    }
  }
  return Transcoder(std::move(impl));
}

Result<Call> Transcoder::read(std::string_view http_method, std::string_view target,
                              std::string_view body) const {
  HP_ASSIGN_OR_RETURN(const Match found, impl_->match_of(http_method, path_of(target)));
  const Route& route = *found.route;
  const MessagePtr request = new_message(*route.method->input_type());
  if (!route.stops_motion) HP_RETURN_IF_ERROR(read_body(body, route, *request));
  for (std::size_t i = 0; i < route.path_fields.size(); ++i) {
    HP_RETURN_IF_ERROR(set_from_text(*request, route.path_fields[i], found.values[i]));
  }
  if (!route.stops_motion) HP_RETURN_IF_ERROR(read_query(query_of(target), route, *request));
  return Call{rpc_name(*route.method), route.method->server_streaming(),
              request->SerializeAsString(), route.stops_motion};
}

Result<std::string> Transcoder::method_of(std::string_view http_method,
                                          std::string_view target) const {
  HP_ASSIGN_OR_RETURN(const Match found, impl_->match_of(http_method, path_of(target)));
  return rpc_name(*found.route->method);
}

bool Transcoder::stops_motion(std::string_view http_method, std::string_view target) const {
  const auto found = impl_->match_of(http_method, path_of(target));
  return found && found->route->stops_motion;
}

std::vector<std::string> Transcoder::methods_at(std::string_view target) const {
  const auto matches = impl_->matches(path_of(target));
  return matches ? methods_of(*matches) : std::vector<std::string>{};
}

Result<std::string> Transcoder::write(std::string_view method, std::string_view response) const {
  const pb::MethodDescriptor* called = impl_->method(method);
  if (called == nullptr) return fail(Code::kInternal, plain(method) + ": unknown method");
  const MessagePtr message = parsed(*called->output_type(), response);
  if (message == nullptr) {
    return fail(Code::kInternal, called->full_name() + ": the response cannot be parsed");
  }
  return write_json(*message);
}

Result<std::optional<RawBody>> Transcoder::raw_body(std::string_view method,
                                                    std::string_view response) const {
  const pb::MethodDescriptor* called = impl_->method(method);
  if (called == nullptr || !called->options().HasExtension(v1::raw_answer)) return std::nullopt;
  const v1::RawAnswer& raw = called->options().GetExtension(v1::raw_answer);
  const auto* field = called->output_type()->FindFieldByName(raw.field());
  const MessagePtr message = parsed(*called->output_type(), response);
  if (message == nullptr || field == nullptr || field->type() != pb::FieldDescriptor::TYPE_BYTES) {
    return fail(Code::kInternal, called->full_name() + ": the response cannot be sent as bytes");
  }
  RawBody out{raw.media_type(), message->GetReflection()->GetString(*message, field)};
  if (!raw.with_other_fields()) return out;
  message->GetReflection()->ClearField(message.get(), field);
  HP_ASSIGN_OR_RETURN(std::string line, write_json(*message));
  constexpr std::size_t kAligned = 8;
  line.resize((line.size() + kAligned) / kAligned * kAligned - 1, ' ');
  out.bytes.insert(0, line + "\n");
  return out;
}

std::string Transcoder::event_id(std::string_view method, std::string_view response) const {
  const pb::MethodDescriptor* called = impl_->method(method);
  if (called == nullptr || !is_resumable(*called)) return {};
  const MessagePtr message = parsed(*called->output_type(), response);
  if (message == nullptr) return {};
  const auto* seq = number_called(*called->output_type(), "seq");
  const bool is_there = !seq->has_presence() || message->GetReflection()->HasField(*message, seq);
  if (!is_there) return {};
  return std::to_string(message->GetReflection()->GetInt64(*message, seq));
}

Result<Call> Transcoder::resume(Call call, std::string_view last_event_id) const {
  const pb::MethodDescriptor* called = impl_->method(call.method);
  if (called == nullptr || !is_resumable(*called)) return call;
  const MessagePtr request = parsed(*called->input_type(), call.request);
  if (request == nullptr)
    return fail(Code::kInternal, call.method + ": the request cannot be parsed");
  const bool is_number =
      !last_event_id.empty() && std::all_of(last_event_id.begin(), last_event_id.end(),
                                            [](char c) { return c >= '0' && c <= '9'; });
  if (!is_number) {
    return bad_parameter("Last-Event-ID",
                         fmt::format("\"{}\" is not an event id", plain(last_event_id)));
  }
  const auto* after_seq = number_called(*called->input_type(), "after_seq");
  HP_RETURN_IF_ERROR(set_from_text(*request, {after_seq}, std::string(last_event_id)));
  call.request = request->SerializeAsString();
  return call;
}

}  // namespace hydroprint::rest
