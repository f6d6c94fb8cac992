#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hydroprint::http {

/// Which bytes of a file are asked for.
struct ByteRange {
  enum class Kind { kAll, kPart, kNone };
  Kind kind = Kind::kAll;  ///< kNone: bytes that the file does not have
  std::int64_t begin = 0;
  std::int64_t end = 0;  ///< behind the last
};

/// Reads the header Range of RFC 9110: "bytes=10-19", "bytes=10-", "bytes=-5". What it does not
/// understand, and more than one range, is the whole file, as the RFC has it.
[[nodiscard]] ByteRange byte_range(std::string_view header, std::int64_t size);

/// Whether a list of entity tags, as If-None-Match has it, has this one ("*" has any).
[[nodiscard]] bool lists_tag(std::string_view list, std::string_view tag);

/// The header Content-Disposition for a file of this name (UTF-8): RFC 6266, with the name twice if
/// it is more than ASCII.
[[nodiscard]] std::string content_disposition(bool is_inline, std::string_view name);

/// Whether a browser may show files of this type in a page of ours: none that can hold scripts.
[[nodiscard]] bool may_be_shown(std::string_view media_type);

}  // namespace hydroprint::http
