#include "daemon/http/protocol/upload_head.h"

#include <charconv>

#include "daemon/rest/percent.h"

namespace hydroprint::http {

Result<std::string> upload_name(std::string_view path) {
  return rest::decode(path.substr(std::string_view("/v1/").size()));
}

Result<std::int64_t> upload_offset(const HeaderFields& fields) {
  constexpr const char* kName = "Upload-Offset";
  const std::string_view text = fields.find(kName).value_or("");
  std::int64_t offset = -1;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), offset);
  const bool is_number = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
  if (is_number && offset >= 0 && fields.count(kName) == 1) return offset;
  return fail_field(Code::kInvalidArgument, kName,
                    "this header must state the offset of these bytes; a HEAD request returns it",
                    ErrorReason::SPEC_INVALID);
}

}  // namespace hydroprint::http
