#include "sim/base/checked_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/base/input_file.h"

namespace hydroprint {
namespace {

using nlohmann::json;

std::string place(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("line {}, column {}", line, before.size() - line_start);
}

/// Returns whether the text, if it is JSON, nests objects and arrays more than `most` levels deep.
/// Brackets in strings do not count.
bool is_deeper(std::string_view text, int most) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_string = !in_string;
    } else if (!in_string && (c == '{' || c == '[')) {
      if (++depth > most) return true;
    } else if (!in_string && (c == '}' || c == ']')) {
      --depth;
    }
  }
  return false;
}

}  // namespace

Result<json> parse_json(std::string_view text, JsonLimits limits) {
  if (text.size() > limits.bytes) {
    return fail(Code::kInvalidArgument,
                fmt::format("longer than {} bytes. Shorten the JSON", limits.bytes));
  }
  if (is_deeper(text, limits.depth)) {
    return fail(Code::kInvalidArgument,
                fmt::format("nested deeper than {} levels. Remove some levels", limits.depth));
  }
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    return fail(Code::kInvalidArgument,
                place(text, error.byte) + ": not valid JSON. Correct the JSON there");
  } catch (const json::exception&) {
    return fail(Code::kInvalidArgument,
                "contains a number that is too large. Use a smaller number");
  }
}

Result<json> read_json_file(const std::filesystem::path& path) {
  const JsonLimits limits;
  HP_ASSIGN_OR_RETURN(const std::string text, read_text_file(path, limits.bytes));
  auto read = parse_json(text, limits);
  if (!read) read.error().message.insert(0, path.string() + ": ");
  return read;
}

const json& json_at(const json& object, const char* key) {
  static const json null;
  const auto found = object.find(key);  // end() unless it is an object
  return found == object.end() ? null : *found;
}

std::optional<double> json_number(const json& object, const char* key) {
  const json& value = json_at(object, key);
  if (!value.is_number() || !std::isfinite(value.get<double>())) return std::nullopt;
  return value.get<double>();
}

std::optional<std::string> json_string(const json& object, const char* key) {
  const json& value = json_at(object, key);
  return value.is_string() ? std::optional(value.get<std::string>()) : std::nullopt;
}

std::optional<std::uint64_t> json_unsigned(const json& object, const char* key) {
  const json& value = json_at(object, key);
  return value.is_number_unsigned() ? std::optional(value.get<std::uint64_t>()) : std::nullopt;
}

}  // namespace hydroprint
