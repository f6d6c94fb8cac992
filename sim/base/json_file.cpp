#include "sim/base/json_file.h"

#include <algorithm>
#include <string>

#include "sim/base/input_file.h"

namespace hydroprint {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

std::string place(const std::string& text, std::size_t byte) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
  const auto line = 1 + std::count(text.begin(), end, '\n');
  const auto line_start = std::find(std::make_reverse_iterator(end), text.rend(), '\n').base();
  return "line " + std::to_string(line) + ", column " + std::to_string(end - line_start);
}

}  // namespace

Result<nlohmann::json> read_json_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const std::string text, read_text_file(path, kMaxBytes));
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    return fail(Code::kInvalidArgument, path.string() + ": " + place(text, error.byte) +
                                            ": not valid JSON. Correct it there");
  } catch (const nlohmann::json::exception&) {
    return fail(Code::kInvalidArgument,
                path.string() + ": holds a number beyond what can be represented. Correct it");
  }
}

}  // namespace hydroprint
