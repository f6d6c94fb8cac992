#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace hydroprint::mesh {

/// Removes the next word (delimited by `blanks`) from the front of `text` and returns it; empty at
/// the end.
[[nodiscard]] inline std::string_view next_word(std::string_view& text,
                                                std::string_view blanks = " \t") {
  const auto begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) {
    text = {};
    return {};
  }
  const auto end = std::min(text.find_first_of(blanks, begin), text.size());
  const auto word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

/// Parses the whole word as a finite number; nullopt if it is not one. Values too small for a
/// double become 0.
[[nodiscard]] inline std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range && word.find("e-") != word.npos) return 0;
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace hydroprint::mesh
