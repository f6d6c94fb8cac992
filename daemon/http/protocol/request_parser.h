#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/http/protocol/header_fields.h"

namespace hydroprint::http {

/// How a request says where its body ends (RFC 9112, 6.1 and 6.3).
enum class BodyFraming {
  kLength,         ///< by Content-Length; 0 without one
  kChunked,        ///< Transfer-Encoding: chunked
  kUnknownCoding,  ///< chunked after a coding that this server does not know, such as gzip
  kFaulty,         ///< any other Transfer-Encoding: nobody knows where the body ends
};

/// What stands before the body of a request.
struct Head {
  std::string method;
  std::string target;  ///< as it came: "/v1/jobs?pageSize=3"
  int version = 11;    ///< 10 or 11
  HeaderFields fields;
  bool keeps_alive = true;
  BodyFraming framing = BodyFraming::kLength;
  std::optional<std::uint64_t> content_length;
  bool expects_continue = false;

  /// Whether it is known where the body ends, and so where the next request begins.
  [[nodiscard]] bool has_known_end() const {
    return framing == BodyFraming::kLength || framing == BodyFraming::kChunked;
  }
  /// The target up to its query.
  [[nodiscard]] std::string_view path() const {
    return std::string_view(target).substr(0, target.find('?'));
  }
};

/// One request, piece by piece.
class RequestParser {
 public:
  explicit RequestParser(std::uint32_t header_limit_bytes);
  ~RequestParser();
  RequestParser(const RequestParser&) = delete;
  RequestParser& operator=(const RequestParser&) = delete;

  enum class Outcome { kGotOn, kNeedsMore, kMalformed, kHeaderTooLarge };
  /// Takes from the beginning of what has not been taken yet; `used`: how much of it. Gets on by a
  /// head, or by a part of the body.
  [[nodiscard]] Outcome put(std::string_view bytes, std::size_t& used);
  [[nodiscard]] bool has_head() const;
  [[nodiscard]] bool is_done() const;
  /// Once there is one.
  [[nodiscard]] const Head& head() const;
  /// What came of the body since this was asked last.
  [[nodiscard]] std::string take_body();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::http
