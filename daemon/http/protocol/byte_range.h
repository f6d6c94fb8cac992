#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hydroprint::http {

/// The requested bytes of a file.
struct ByteRange {
  enum class Kind { kAll, kPart, kNone };
  Kind kind = Kind::kAll;  ///< kNone: the requested bytes are outside the file
  std::int64_t begin = 0;
  std::int64_t end = 0;  ///< one past the last byte
};

/// Parses the Range header (RFC 9110): "bytes=10-19", "bytes=10-", "bytes=-5". Any other text, or
/// more than one range, means the whole file, as the RFC permits.
[[nodiscard]] ByteRange byte_range(std::string_view header, std::int64_t size);

/// Returns whether a list of entity tags, as in If-None-Match, contains `tag` ("*" matches any
/// tag).
[[nodiscard]] bool lists_tag(std::string_view list, std::string_view tag);

/// Returns the Content-Disposition header for a file name in UTF-8 (RFC 6266). A name with other
/// than plain ASCII characters is given twice: with "_" in their place, and encoded.
[[nodiscard]] std::string content_disposition(bool is_inline, std::string_view name);

/// Returns whether a browser may display files of this type on the daemon's pages: only types that
/// cannot contain scripts.
[[nodiscard]] bool may_be_shown(std::string_view media_type);

}  // namespace hydroprint::http
