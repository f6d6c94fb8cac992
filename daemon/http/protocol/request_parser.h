#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/http/protocol/header_fields.h"

namespace hydroprint::http {

/// How the end of a request's body is determined (RFC 9112, 6.1 and 6.3).
enum class BodyFraming {
  kLength,         ///< Content-Length; a request without it has no body
  kChunked,        ///< Transfer-Encoding: chunked
  kUnknownCoding,  ///< chunked, applied after an unsupported coding such as gzip
  kFaulty,         ///< any other Transfer-Encoding: the end of the body is unknown
};

/// The part of a request before its body.
struct Head {
  std::string method;
  std::string target;  ///< as received: "/v1/jobs?pageSize=3"
  int version = 11;    ///< HTTP version: 10 for HTTP/1.0, 11 for HTTP/1.1
  HeaderFields fields;
  bool keeps_alive = true;
  BodyFraming framing = BodyFraming::kLength;
  std::optional<std::uint64_t> content_length;
  bool expects_continue = false;

  /// Returns whether the end of the body is known, and with it the start of the next request.
  [[nodiscard]] bool has_known_end() const {
    return framing == BodyFraming::kLength || framing == BodyFraming::kChunked;
  }
  /// Returns the target without its query.
  [[nodiscard]] std::string_view path() const {
    return std::string_view(target).substr(0, target.find('?'));
  }
};

/// Parses one request incrementally.
class RequestParser {
 public:
  explicit RequestParser(std::uint32_t header_limit_bytes);
  ~RequestParser();
  RequestParser(const RequestParser&) = delete;
  RequestParser& operator=(const RequestParser&) = delete;

  enum class Outcome { kProgress, kNeedsMore, kMalformed, kHeaderTooLarge };
  /// Parses the next bytes and sets `used` to the number consumed. Each call completes the head or
  /// consumes a part of the body.
  [[nodiscard]] Outcome put(std::string_view bytes, std::size_t& used);
  [[nodiscard]] bool has_head() const;
  [[nodiscard]] bool is_done() const;
  /// Returns the head; requires has_head().
  [[nodiscard]] const Head& head() const;
  /// Returns the body bytes parsed since the last call.
  [[nodiscard]] std::string take_body();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::http
