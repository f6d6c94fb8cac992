#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/http/protocol/header_fields.h"
#include "daemon/http/protocol/request_parser.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// A whole response or, without a body, the beginning of one.
struct Response {
  int status = 200;
  HeaderFields fields;
  std::string body;
  std::shared_ptr<const std::string> shared_body;  ///< used instead of `body`: content of a file

  [[nodiscard]] const std::string& content() const { return shared_body ? *shared_body : body; }
};

/// How the end of a response's body is marked.
struct Framing {
  /// nullopt: chunked, or until the connection closes for HTTP/1.0.
  std::optional<std::uint64_t> length;
  bool keeps_alive = true;
  bool is_secure = false;  ///< over TLS: instructs browsers to use only TLS afterwards
};

/// Returns the status line and header fields, including the security headers common to all
/// responses. These forbid MIME sniffing, framing and referrers. Caching is forbidden unless
/// `response` sets Cache-Control.
[[nodiscard]] std::string head_text(const Response& response, const Head& request,
                                    const Framing& framing);

/// Returns a response with type application/json.
[[nodiscard]] Response json_response(int status, std::string json);
/// Returns a response with type text/plain.
[[nodiscard]] Response text_response(int status, std::string text);

/// Converts an error to google.rpc.Status JSON; the HTTP status follows from the code unless given.
[[nodiscard]] Response refusal(const Error& error, std::optional<int> status = {});

}  // namespace hydroprint::http
