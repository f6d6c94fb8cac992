#include "daemon/platform/resource_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <random>

namespace hydroprint::daemon {
namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < ' ' || c == 0x7f; }
bool is_hex(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }

// Makes a client's text safe for messages: shortened, without control characters.
std::string shown(std::string_view text) {
  std::string out(text.substr(0, 80));
  std::replace_if(out.begin(), out.end(), is_control, '?');
  return fmt::format("\"{}{}\"", out, text.size() > 80 ? "..." : "");
}

tl::unexpected<Error> bad_id(std::string_view name, const std::string& pattern) {
  return fail(Code::kInvalidArgument, fmt::format("{} is not of the form {}", shown(name), pattern),
              ErrorReason::ID_INVALID);
}

bool is_plain_part(std::string_view part) {
  return !part.empty() && part != "." && part != ".." && part.front() != '-' &&
         std::none_of(part.begin(), part.end(), is_control) &&
         part.find_first_of("/\\") == std::string_view::npos;
}

}  // namespace

tl::unexpected<Error> invalid_field(std::string_view field, std::string_view problem) {
  return fail_field(Code::kInvalidArgument, std::string(field), std::string(problem),
                    ErrorReason::SPEC_INVALID);
}

Status check_text(std::string_view field, std::string_view text, std::size_t max_bytes) {
  if (text.size() > max_bytes) {
    return invalid_field(field, fmt::format("is longer than {} bytes; shorten it", max_bytes));
  }
  if (std::any_of(text.begin(), text.end(), is_control)) {
    return invalid_field(field, "has control characters; leave them out");
  }
  return {};
}

Status check_file_name(std::string_view field, std::string_view name) {
  bool plain = !name.empty() && name.size() <= 255;
  for (std::size_t begin = 0; plain && begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    plain = is_plain_part(name.substr(begin, end - begin));
    begin = end + 1;
  }
  if (plain) return {};
  return fail_field(
      Code::kInvalidArgument, std::string(field),
      fmt::format("{} is not a plain file name; use one like \"spot.obj\" or \"textures/a.png\"",
                  shown(name)),
      ErrorReason::NAME_INVALID);
}

bool is_sha256(std::string_view text) {
  return text.size() == 64 && std::all_of(text.begin(), text.end(), is_hex);
}

Result<std::int64_t> parse_job_name(std::string_view name) {
  const std::int64_t id = name.starts_with("jobs/") ? parse_number(name.substr(5)) : 0;
  if (id == 0) return bad_id(name, "jobs/{number}");
  return id;
}

Result<std::int64_t> parse_calibration_name(std::string_view name) {
  constexpr std::string_view kBegin = "calibrations/";
  const std::int64_t id = name.starts_with(kBegin) ? parse_number(name.substr(kBegin.size())) : 0;
  if (id == 0) return bad_id(name, "calibrations/{number}");
  return id;
}

Result<std::string> parse_asset_name(std::string_view name) {
  if (!name.starts_with("assets/") || !is_sha256(name.substr(7))) {
    return bad_id(name, "assets/{sha256 as 64 lower-case hex digits}");
  }
  return std::string(name.substr(7));
}

Result<std::string> parse_upload_name(std::string_view name) {
  const std::string_view id = name.starts_with("uploads/") ? name.substr(8) : std::string_view();
  if (id.size() != 32 || !std::all_of(id.begin(), id.end(), is_hex)) {
    return bad_id(name, "uploads/{32 hex digits}");
  }
  return std::string(id);
}

Result<std::pair<std::int64_t, std::string>> parse_artifact_name(std::string_view name) {
  static constexpr std::string_view kMiddle = "/artifacts/";
  const std::size_t middle = name.find(kMiddle);
  if (middle == std::string_view::npos) return bad_id(name, "jobs/{number}/artifacts/{file name}");
  HP_ASSIGN_OR_RETURN(const std::int64_t job, parse_job_name(name.substr(0, middle)));
  const std::string_view file = name.substr(middle + kMiddle.size());
  HP_RETURN_IF_ERROR(check_file_name("name", file));
  return std::pair(job, std::string(file));
}

std::string calibration_name(std::int64_t id) { return fmt::format("calibrations/{}", id); }

std::string job_name(std::int64_t id) { return fmt::format("jobs/{}", id); }

std::int64_t parse_number(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && number > 0 && text.front() != '0' ? number : 0;
}

std::string make_token() {
  static constexpr char kHex[] = "0123456789abcdef";
  std::random_device random;
  std::string out;
  while (out.size() < 32) {
    for (unsigned bits = random(), i = 0; i < 8; ++i, bits >>= 4) out += kHex[bits & 15];
  }
  return out;
}

std::string make_uuid() {
  std::string id = make_token();
  id[12] = '4';
  id[16] = "89ab"[(id[16] <= '9' ? id[16] - '0' : id[16] - 'a') & 3];
  for (const std::size_t at : {20, 16, 12, 8}) id.insert(at, 1, '-');
  return id;
}

}  // namespace hydroprint::daemon
