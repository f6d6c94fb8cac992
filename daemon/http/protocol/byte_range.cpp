#include "daemon/http/protocol/byte_range.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "daemon/http/protocol/header_fields.h"
#include "daemon/rest/percent.h"

namespace hydroprint::http {
namespace {

// Parses a number. If it exceeds 64 bits, returns INT64_MAX, which lies beyond the end of every
// file.
std::optional<std::int64_t> byte_number(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string_view::npos) return {};
  std::int64_t number = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  return parsed.ec == std::errc() ? number : INT64_MAX;
}

}  // namespace

ByteRange byte_range(std::string_view header, std::int64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  const ByteRange all{ByteRange::Kind::kAll, 0, size}, none{ByteRange::Kind::kNone, 0, 0};
  if (!same_name(header.substr(0, kUnit.size()), kUnit)) return all;
  const std::string_view range = trimmed(header.substr(kUnit.size()));
  const std::size_t dash = range.find('-');
  if (dash == std::string_view::npos) return all;
  const auto first = byte_number(range.substr(0, dash));
  const auto last = byte_number(range.substr(dash + 1));
  if (dash == 0) {
    if (!last) return all;
    if (*last == 0 || size == 0) return none;
    return {ByteRange::Kind::kPart, size - std::min(*last, size), size};
  }
  const bool is_open = dash + 1 == range.size();
  if (!first || (!last && !is_open) || (last && *last < *first)) return all;
  if (*first >= size) return none;
  return {ByteRange::Kind::kPart, *first, is_open ? size : std::min(*last, size - 1) + 1};
}

bool lists_tag(std::string_view list, std::string_view tag) {
  const auto tags = parts_of(list, ',');
  return std::any_of(tags.begin(), tags.end(), [&](std::string_view one) {
    if (one.starts_with("W/")) one.remove_prefix(2);
    return one == "*" || one == tag;
  });
}

std::string content_disposition(bool is_inline, std::string_view name) {
  std::string plain;
  for (const char c : name) {
    const bool is_plain = c >= ' ' && c < 0x7f && c != '"' && c != '\\' && c != '%';
    plain += is_plain ? c : '_';
  }
  std::string text =
      std::string(is_inline ? "inline" : "attachment") + "; filename=\"" + plain + '"';
  if (plain != name) text += "; filename*=UTF-8''" + rest::encode(name);
  return text;
}

bool may_be_shown(std::string_view media_type) {
  static constexpr std::array<std::string_view, 5> kShown{"image/png", "application/json",
                                                          "text/csv", "model/ply", "image/x-exr"};
  return std::find(kShown.begin(), kShown.end(), media_type) != kShown.end();
}

}  // namespace hydroprint::http
