// Answers requests for methods of the services.
#include "daemon/http/rpc_call.h"

#include <algorithm>

#include "daemon/http/artifact_path.h"
#include "daemon/http/credentials.h"
#include "daemon/http/download.h"
#include "daemon/http/error_response.h"
#include "daemon/http/idempotency_key.h"
#include "daemon/http/protocol/async_value.h"
#include "daemon/http/session_cookie.h"
#include "daemon/http/sse.h"
#include "daemon/rest/answer.h"

namespace hydroprint::http {
namespace {

constexpr milliseconds kGrace{5000};  // time for gRPC to report the timeout of a call

// "/hydroprint.v1.JobService/GetJob" -> "JobService/GetJob".
std::string short_name(const std::string& method) {
  return method.substr(method.rfind('.', method.rfind('/')) + 1);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// Returns the methods allowed on a path, including OPTIONS and HEAD, which HTTP adds.
std::string allowed_at(const ServerContext& server, const std::string& target) {
  std::vector<std::string> methods = server.transcoder.methods_at(target);
  const bool is_artifact = artifact_target(target).has_value();
  if (is_artifact) methods = {"GET"};
  if (std::find(methods.begin(), methods.end(), "GET") != methods.end()) {
    methods.emplace_back("HEAD");
  }
  if (!methods.empty() && target.starts_with("/v1/uploads/")) {
    methods.emplace_back("PATCH");
  }
  if (!methods.empty()) methods.emplace_back("OPTIONS");
  return joined(methods);
}

Task<std::string> answer_options(const ServerContext& server, Exchange& exchange) {
  Response response;
  response.status = 204;
  const std::string allowed = allowed_at(server, exchange.head().target);
  if (allowed.empty()) {
    response = refusal({Code::kNotFound,
                        "no endpoint exists at this path; see /openapi.json",
                        ErrorReason::ROUTE_NOT_FOUND,
                        {}});
  } else {
    response.fields.set("Allow", allowed);
  }
  co_await exchange.send(std::move(response));
  co_return "options";
}

// Returns the answer to a call that succeeded: JSON, or the bytes of a field.
Result<Response> response_of(const ServerContext& server, const std::string& method,
                             const std::string& message) {
  HP_ASSIGN_OR_RETURN(std::optional<rest::RawBody> raw,
                      server.transcoder.raw_body(method, message));
  if (raw) {
    Response response;
    response.fields.set("Content-Type", raw->media_type);
    response.body = std::move(raw->bytes);
    return response;
  }
  HP_ASSIGN_OR_RETURN(std::string json, server.transcoder.write(method, message));
  return json_response(200, std::move(json));
}

Task<void> answer_unary(ServerContext& server, Exchange& exchange, rest::Call request,
                        InProcessChannel::Metadata metadata) {
  const std::string method = request.method;
  Reply reply = co_await call(server, exchange, std::move(request), std::move(metadata));
  if (!reply.ok()) {
    co_await exchange.send(refusal(reply));
    co_return;
  }
  const auto set_cookie = take_session(method, reply.response, exchange.socket().is_secure());
  Result<Response> made = response_of(server, method, reply.response);
  if (!made) {
    co_await refuse(exchange, made.error());
    co_return;
  }
  Response response = std::move(*made);
  if (set_cookie) response.fields.set("Set-Cookie", *set_cookie);
  co_await exchange.send(std::move(response));
}

// Reads the body, except for calls that stop motion: they must not wait for a body that may never
// arrive.
Task<Result<std::string>> body_of(const ServerContext& server, Exchange& exchange) {
  const Head& head = exchange.head();
  if (server.transcoder.stops_motion(head.method, head.target)) co_return std::string();
  co_return co_await exchange.read_body();
}

// Answers a request that the transcoder rejected.
Task<std::string> refuse_call(const ServerContext& server, Exchange& exchange, Error error) {
  Response response = refusal(error);
  if (error.reason == ErrorReason::METHOD_NOT_ALLOWED) {
    response = refusal(error, 405);
    response.fields.set("Allow", allowed_at(server, exchange.head().target));
  }
  co_await exchange.send(std::move(response));
  co_return "refused";
}

}  // namespace

Task<Reply> call(ServerContext& server, Exchange& exchange, rest::Call request,
                 InProcessChannel::Metadata metadata) {
  AsyncValue<Reply> async_value(exchange.shared_socket());
  const milliseconds patience = server.options.limits.call_time;
  const auto under_way =
      server.rpc.unary(request.method, request.request, metadata, patience, async_value.receiver());
  if (!request.stops_motion) exchange.socket().watch([under_way] { under_way->cancel(); });
  const bool in_time = co_await async_value.wait(patience + kGrace);
  exchange.socket().unwatch();
  if (in_time) co_return async_value.take();
  under_way->cancel();
  co_return Reply{4, "the daemon did not answer in time; check whether the request was executed",
                  "", ""};
}

Task<std::string> answer_call(ServerContext& server, Exchange& exchange) {
  const Head& head = exchange.head();
  if (head.method == "OPTIONS") co_return co_await answer_options(server, exchange);
  if (auto artifact = artifact_target(head.target)) {
    co_return co_await answer_download(server, exchange, std::move(*artifact));
  }
  const bool wants_head = head.method == "HEAD";
  const std::string http_method = wants_head ? "GET" : head.method;
  const Result<std::string> method = server.transcoder.method_of(http_method, head.target);
  if (!method) co_return co_await refuse_call(server, exchange, method.error());
  Result<InProcessChannel::Metadata> metadata = admit(server, exchange, *method);
  if (!metadata) {
    co_await refuse(exchange, metadata.error());
    co_return "refused";
  }
  Result<std::string> body = co_await body_of(server, exchange);
  if (!body) {
    const bool is_too_long = body.error().reason == ErrorReason::BODY_TOO_LARGE;
    const bool is_late = body.error().reason == ErrorReason::REQUEST_TIMED_OUT;
    const std::optional<int> status = is_too_long ? std::optional(413)
                                      : is_late   ? std::optional(408)
                                                  : std::nullopt;
    co_await refuse(exchange, body.error(), status);
    co_return "refused";
  }
  Result<rest::Call> request = server.transcoder.read(http_method, head.target, *body);
  if (request && request->streams && wants_head) {
    request = fail(Code::kUnimplemented, "HEAD is not supported for streams; use GET",
                   ErrorReason::METHOD_NOT_ALLOWED);
  }
  const auto last_event = head.fields.find("Last-Event-ID");
  if (request && request->streams && last_event) {
    request = server.transcoder.resume(std::move(*request), *last_event);
  }
  if (!request) co_return co_await refuse_call(server, exchange, request.error());
  if (const auto key = head.fields.find("Idempotency-Key")) {
    request->request = with_request_id(request->method, request->request, *key);
  }
  const std::string name = short_name(request->method);
  if (request->streams) {
    co_await answer_events(server, exchange, std::move(*request), *metadata);
  } else {
    co_await answer_unary(server, exchange, std::move(*request), std::move(*metadata));
  }
  co_return name;
}

}  // namespace hydroprint::http
