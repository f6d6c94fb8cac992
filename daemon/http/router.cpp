// Selects the handler for each request.
#include "daemon/http/router.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/http/error_response.h"
#include "daemon/http/rpc_call.h"
#include "daemon/http/session_cookie.h"
#include "daemon/http/system_pages.h"
#include "daemon/http/upload.h"
#include "daemon/rest/percent.h"

namespace hydroprint::http {
namespace {

bool is_safe(const std::string& method) {
  return method == "GET" || method == "HEAD" || method == "OPTIONS";
}

bool is_port(std::string_view text) {
  return text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Removes the port: "localhost:8080" -> "localhost"; "[::1]:8080" -> "[::1]"; empty for other text.
std::string_view without_port(std::string_view host) {
  const std::size_t begin = host.starts_with('[') ? host.find(']') : 0;
  if (begin == std::string_view::npos) return {};
  const std::size_t colon = host.find(':', begin);
  if (colon == std::string_view::npos) return host;
  return is_port(host.substr(colon + 1)) ? host.substr(0, colon) : std::string_view();
}

// Returns whether `host` names this server. This prevents DNS rebinding, in which the host name of
// a foreign page resolves to this address, so that browsers send that name as Host.
bool is_ours(const Options& options, std::string_view host) {
  const std::string_view name = without_port(host);
  const auto is = [&](std::string_view ours) { return same_name(name, ours); };
  return is("localhost") || is("127.0.0.1") || is("[::1]") || is(options.host) ||
         is("[" + options.host + "]") ||
         std::any_of(options.host_names.begin(), options.host_names.end(), is) ||
         (options.identity && tls::stands_for(*options.identity(), name));
}

// Returns whether a request comes from a page of another origin, such as a form there. Browsers
// send the origin of the page. With TLS, origins without TLS also count as foreign, because others
// on the network can forge their pages.
bool comes_from_elsewhere(const Head& head, bool is_secure) {
  const auto origin = head.fields.find("Origin");
  if (!origin) return same_name(head.fields.find("Sec-Fetch-Site").value_or(""), "cross-site");
  const std::size_t scheme = origin->find("://");
  return scheme == std::string_view::npos ||
         (is_secure && !same_name(origin->substr(0, scheme), "https")) ||
         !same_name(origin->substr(scheme + 3), head.fields.find("Host").value_or(""));
}

constexpr const char* kProxyRemedy =
    "A reverse proxy must pass on the header Host of the browser (nginx: proxy_set_header Host "
    "$http_host), and server.host_names must contain its name";

// Returns a header's value for an error message.
std::string shown(const Head& head, std::string_view name) {
  return fmt::format("{}: {}", name, rest::plain(head.fields.find(name).value_or("missing")));
}

Error unknown_host(const Head& head) {
  return {
      Code::kPermissionDenied,
      fmt::format("unknown host name ({}); use a name of the server's certificate (or 127.0.0.1 "
                  "on the server itself), or add this name to server.host_names. {}",
                  shown(head, "Host"), kProxyRemedy),
      ErrorReason::HOST_UNKNOWN,
      {}};
}

Error foreign_origin(const Head& head) {
  const char* page = head.fields.find("Origin") ? "Origin" : "Sec-Fetch-Site";
  return {Code::kPermissionDenied,
          fmt::format("the request comes from a page of another site ({}; {}); only this server's "
                      "own pages may send it. {}",
                      shown(head, page), shown(head, "Host"), kProxyRemedy),
          ErrorReason::ORIGIN_FORBIDDEN,
          {}};
}

// Returns an error if the end of the body is unknown. Calls that stop motion are exempt, because
// they are executed from the head of the request alone; their connection is closed afterwards.
std::optional<Response> refused_framing(const ServerContext& server, const Head& head) {
  if (head.has_known_end() || server.transcoder.stops_motion(head.method, head.target)) return {};
  const bool is_unknown = head.framing == BodyFraming::kUnknownCoding;
  return refusal({is_unknown ? Code::kUnimplemented : Code::kInvalidArgument,
                  "Transfer-Encoding is allowed only as \"chunked\", in HTTP/1.1 and without "
                  "Content-Length; otherwise send only Content-Length",
                  ErrorReason::REQUEST_MALFORMED,
                  {}},
                 is_unknown ? 501 : 400);
}

std::optional<Response> refused(const ServerContext& server, const Head& head, bool is_secure) {
  if (auto response = refused_framing(server, head)) return response;
  const std::size_t hosts = head.fields.count("Host");
  if (hosts > 1 || (hosts == 0 && head.version >= 11)) {
    return refusal({Code::kInvalidArgument,
                    "the header Host must occur exactly once",
                    ErrorReason::REQUEST_MALFORMED,
                    {}});
  }
  if (hosts == 1 && !is_ours(server.options, *head.fields.find("Host"))) {
    return refusal(unknown_host(head), 421);
  }
  if (!is_safe(head.method) && comes_from_elsewhere(head, is_secure)) {
    return refusal(foreign_origin(head));
  }
  if (const Status good = check_csrf(head); !good) return refusal(good.error());
  return {};
}

// Answers methods other than GET and HEAD on a path that supports only these two. Returns whether
// it sent a response.
Task<bool> is_refused_method(Exchange& exchange) {
  const std::string& method = exchange.head().method;
  if (method == "GET" || method == "HEAD") co_return false;
  Response response;
  response.status = 204;
  if (method != "OPTIONS") {
    response = refusal({Code::kUnimplemented,
                        "only GET and HEAD are allowed here",
                        ErrorReason::METHOD_NOT_ALLOWED,
                        {}},
                       405);
  }
  response.fields.set("Allow", "GET, HEAD, OPTIONS");
  co_await exchange.send(std::move(response));
  co_return true;
}

Task<std::string> answer_openapi(ServerContext& server, Exchange& exchange) {
  co_await exchange.send(json_response(200, server.openapi));
  co_return "openapi";
}

bool is_upload(std::string_view path) {
  constexpr std::string_view kUploads = "/v1/uploads/";
  return path.starts_with(kUploads) && path.size() > kUploads.size() &&
         path.find('/', kUploads.size()) == std::string_view::npos;
}

}  // namespace

Task<std::string> answer(ServerContext& server, Exchange& exchange) {
  const Head& head = exchange.head();
  if (auto response = refused(server, head, exchange.socket().is_secure())) {
    co_await exchange.send(std::move(*response));
    co_return "refused";
  }
  const std::string_view path = head.path();
  const bool is_bytes = head.method == "PATCH" || head.method == "HEAD";
  if (is_bytes && is_upload(path)) co_return co_await answer_upload(server, exchange);
  if (path.starts_with("/v1/")) co_return co_await answer_call(server, exchange);
  const bool is_refused = co_await is_refused_method(exchange);
  if (is_refused) co_return "refused";
  if (path == "/healthz") co_return co_await answer_health(server, exchange);
  if (path == "/metrics") co_return co_await answer_metrics(server, exchange);
  if (path == "/openapi.json") co_return co_await answer_openapi(server, exchange);
  co_return co_await answer_file(server, exchange);
}

}  // namespace hydroprint::http
