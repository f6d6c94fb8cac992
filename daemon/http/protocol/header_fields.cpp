#include "daemon/http/protocol/header_fields.h"

#include <algorithm>

namespace hydroprint::http {
namespace {

bool is_token_character(char c) {
  const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  return is_letter || (c >= '0' && c <= '9') ||
         std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_token_character);
}

bool stays_in_its_line(std::string_view text) {
  return text.find_first_of(std::string_view("\r\n\0", 3)) == std::string_view::npos;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; }

}  // namespace

bool same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string_view> parts_of(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    const std::string_view part = trimmed(text.substr(begin, end - begin));
    if (!part.empty()) parts.push_back(part);
    begin = end + 1;
  }
  return parts;
}

bool HeaderFields::set(std::string_view name, std::string_view value) {
  if (!is_token(name) || !stays_in_its_line(value)) return false;
  std::erase_if(fields_, [&](const HeaderField& field) { return same_name(field.name, name); });
  fields_.push_back({std::string(name), std::string(value)});
  return true;
}

void HeaderFields::add(std::string name, std::string value) {
  fields_.push_back({std::move(name), std::move(value)});
}

std::optional<std::string_view> HeaderFields::find(std::string_view name) const {
  for (const HeaderField& field : fields_) {
    if (same_name(field.name, name)) return field.value;
  }
  return {};
}

std::size_t HeaderFields::count(std::string_view name) const {
  return static_cast<std::size_t>(
      std::count_if(fields_.begin(), fields_.end(),
                    [&](const HeaderField& f) { return same_name(f.name, name); }));
}

std::vector<std::string_view> HeaderFields::words(std::string_view name) const {
  std::vector<std::string_view> all;
  for (const HeaderField& field : fields_) {
    if (!same_name(field.name, name)) continue;
    const auto words = parts_of(field.value, ',');
    all.insert(all.end(), words.begin(), words.end());
  }
  return all;
}

bool HeaderFields::lists(std::string_view name, std::string_view word) const {
  const auto all = words(name);
  return std::any_of(all.begin(), all.end(), [&](auto one) { return same_name(one, word); });
}

}  // namespace hydroprint::http
