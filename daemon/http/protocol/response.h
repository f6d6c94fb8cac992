#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/http/protocol/header_fields.h"
#include "daemon/http/protocol/request_parser.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// A whole response, or the head of a response whose body is sent separately.
struct Response {
  int status = 200;
  HeaderFields fields;
  std::string body;
  std::shared_ptr<const std::string> shared_body;  ///< used instead of `body`: content of a file

  [[nodiscard]] const std::string& content() const { return shared_body ? *shared_body : body; }
};

/// How the end of a response's body is marked.
struct Framing {
  /// Length of the body; nullopt: the body is chunked or, for HTTP/1.0, ends with the connection.
  std::optional<std::uint64_t> length;
  bool keeps_alive = true;
  bool is_secure = false;  ///< the connection uses TLS: adds Strict-Transport-Security
};

/// Returns the status line and header fields, including the security headers common to all
/// responses. The security headers forbid MIME sniffing, framing and referrers. Caching is
/// forbidden unless `response` sets Cache-Control.
[[nodiscard]] std::string head_text(const Response& response, const Head& request,
                                    const Framing& framing);

/// Returns a response with type application/json.
[[nodiscard]] Response json_response(int status, std::string json);
/// Returns a response with type text/plain.
[[nodiscard]] Response text_response(int status, std::string text);

/// Returns the error response, with google.rpc.Status as JSON.
/// @param status  the HTTP status; by default that of the error's code
[[nodiscard]] Response refusal(const Error& error, std::optional<int> status = {});

}  // namespace hydroprint::http
