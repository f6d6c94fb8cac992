#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
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

/// Removes the next line from the front of `text` and returns it without its end: LF, CR, or both.
[[nodiscard]] inline std::string_view next_line(std::string_view& text) {
  const auto is_end = [](char c) { return c == '\n' || c == '\r'; };  // find_first_of is slow
  const auto end = static_cast<std::size_t>(std::ranges::find_if(text, is_end) - text.begin());
  const auto line = text.substr(0, end);
  text.remove_prefix(end);
  text.remove_prefix(text.starts_with("\r\n") ? 2 : text.empty() ? 0 : 1);
  return line;
}

/// Returns the text without blanks and line ends around it.
[[nodiscard]] inline std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == text.npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1));
}

/// Returns the text with its ASCII letters in lower case.
[[nodiscard]] inline std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
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

/// Returns true for the words by which programs write NaN and infinity: nan, -nan(ind), 1.#QNAN,
/// -1.#IND, inf, 1.#INF.
[[nodiscard]] inline bool is_not_finite(std::string_view word) {
  const std::string text = lower_case(word);
  for (const std::string_view mark : {"nan", "inf", "#ind", "#snan", "#qnan"})
    if (text.find(mark) != text.npos) return true;
  return false;
}

}  // namespace hydroprint::mesh
