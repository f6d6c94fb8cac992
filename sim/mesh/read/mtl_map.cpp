#include "sim/mesh/read/mtl_map.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>

#include "sim/base/utf8.h"
#include "sim/mesh/read/numbers.h"

namespace hydroprint::mesh {
namespace {

/// Arguments of an option: a range of numbers, or one word.
struct Shape {
  int least = 0;
  int most = 0;  ///< 0: one word
};

const std::map<std::string, Shape>& shapes() {
  static const std::map<std::string, Shape> all = {
      {"-blendu", {}},    {"-blendv", {}},     {"-cc", {}},         {"-clamp", {}},
      {"-imfchan", {}},   {"-type", {}},       {"-colorspace", {}}, {"-bm", {1, 1}},
      {"-boost", {1, 1}}, {"-texres", {1, 2}}, {"-mm", {1, 2}},     {"-o", {1, 3}},
      {"-s", {1, 3}},     {"-t", {1, 3}}};
  return all;
}

/// An option as written.
struct Option {
  std::string name;
  std::string word;
  std::array<double, 3> values = {};
  int count = 0;
};

/// Takes the option at the front of `text`.
/// @return nullopt, with `text` unchanged, if it has an unknown name or lacks its arguments
std::optional<Option> take_option(std::string_view& text) {
  std::string_view rest = text;
  Option option{lower_case(next_word(rest)), {}, {}, 0};
  const auto shape = shapes().find(option.name);
  if (shape == shapes().end()) return {};
  if (shape->second.most == 0) {
    option.word = lower_case(next_word(rest));
    if (option.word.empty()) return {};
  }
  while (option.count < shape->second.most) {
    std::string_view after = rest;
    const auto value = parse_number(next_word(after));
    if (!value) break;
    option.values[static_cast<std::size_t>(option.count++)] = *value;
    rest = after;
  }
  if (option.count < shape->second.least) return {};
  text = rest;
  return option;
}

Eigen::Vector3f vector_of(const Option& option, Eigen::Vector3f otherwise) {
  for (int k = 0; k < option.count; ++k)
    otherwise[k] = static_cast<float>(option.values[static_cast<std::size_t>(k)]);
  return otherwise;
}

bool changes_picture(const Option& option) {
  const auto& v = option.values;
  if (option.name == "-mm") return v[0] != 0 || (option.count > 1 && v[1] != 1);
  if (option.name == "-t") return v[0] != 0 || v[1] != 0 || v[2] != 0;
  if (option.name == "-imfchan") return option.word != "m";
  return false;
}

void apply(const Option& option, MtlMap& map) {
  if (option.name == "-clamp") map.clamp = option.word == "on";
  if (option.name == "-s") map.scale = vector_of(option, map.scale);
  if (option.name == "-o") map.offset = vector_of(option, map.offset);
  if (changes_picture(option)) map.ignored = option.name;
}

/// Returns the options of a text that consists of nothing else; nullopt if it has other words.
std::optional<MtlMap> only_options(std::string_view text, MtlMap map) {
  while (!trimmed(text).empty()) {
    const auto option = take_option(text);
    if (!option) return {};
    apply(*option, map);
  }
  return map;
}

/// Takes the options behind the file name.
void take_trailing(MtlMap& map) {
  for (auto at = map.file.find(" -"); at != map.file.npos; at = map.file.find(" -", at + 1)) {
    const std::string name = trimmed(std::string_view(map.file).substr(0, at));
    auto found =
        name.empty() ? std::nullopt : only_options(std::string_view(map.file).substr(at), map);
    if (!found) continue;
    map = std::move(*found);
    map.file = name;
    return;
  }
}

}  // namespace

tl::expected<MtlMap, std::string> parse_mtl_map(std::string_view text) {
  MtlMap map;
  while (true) {
    std::string_view rest = text;
    const std::string_view word = next_word(rest);
    if (!word.starts_with('-')) break;
    const auto option = take_option(text);
    if (!option) {
      if (trimmed(text).find('.') != std::string::npos && !shapes().contains(lower_case(word)) &&
          trimmed(rest).empty())
        break;  // a file whose name begins with a dash
      return tl::unexpected(
          fmt::format("the option \"{}\" of the texture is unknown or lacks its numbers; correct "
                      "it, or remove it",
                      one_line(std::string(word.substr(0, 40)))));
    }
    apply(*option, map);
  }
  map.file = trimmed(text);
  take_trailing(map);
  if (map.file.size() > 1 && map.file.front() == '"' && map.file.back() == '"')
    map.file = map.file.substr(1, map.file.size() - 2);
  return map;
}

}  // namespace hydroprint::mesh
