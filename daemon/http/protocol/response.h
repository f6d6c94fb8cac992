#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/http/protocol/header_fields.h"
#include "daemon/http/protocol/request_parser.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// An answer, whole or (without body) the beginning of one.
struct Response {
  int status = 200;
  HeaderFields fields;
  std::string body;
  std::shared_ptr<const std::string> shared_body;  ///< in place of `body`: of a file

  [[nodiscard]] const std::string& content() const { return shared_body ? *shared_body : body; }
};

/// How the body of an answer ends.
struct Framing {
  std::optional<std::uint64_t> length;  ///< else chunked, or for HTTP/1.0 with the connection
  bool keeps_alive = true;
  bool is_secure = false;  ///< over TLS: browsers are told to come back by it alone
};

/// Status line and fields, with those that every answer has: nothing is sniffed, framed or told to
/// others, and nothing is kept by caches unless `response` says so.
[[nodiscard]] std::string head_text(const Response& response, const Head& request,
                                    const Framing& framing);

/// "application/json".
[[nodiscard]] Response json_response(int status, std::string json);
/// "text/plain".
[[nodiscard]] Response text_response(int status, std::string text);

/// A refusal as google.rpc.Status JSON; the status is the code's unless given.
[[nodiscard]] Response refusal(const Error& error, std::optional<int> status = {});

}  // namespace hydroprint::http
