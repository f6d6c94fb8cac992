#include "client/files/references.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>

#include "client/files/files.h"
#include "sim/base/checked_json.h"

namespace hydroprint::client {
namespace {

constexpr std::int64_t kMaxJsonBytes = std::int64_t{256} << 20;
constexpr std::int64_t kMaxMtlBytes = std::int64_t{16} << 20;
constexpr std::int64_t kMaxHeaderBytes = 65536;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string_view unquote(std::string_view text) {
  while (text.starts_with('"')) text.remove_prefix(1);
  while (text.ends_with('"')) text.remove_suffix(1);
  return trim(text);
}

/// Returns the first word and the rest of the text.
std::pair<std::string_view, std::string_view> word(std::string_view text) {
  text = trim(text);
  const auto end = text.find_first_of(" \t");
  if (end == std::string_view::npos) return {text, {}};
  return {text.substr(0, end), trim(text.substr(end))};
}

// Collects the files that a model refers to.
class Collector {
 public:
  explicit Collector(const std::filesystem::path& model)
      : folder_(model.parent_path()), model_name_(model.filename().string()) {}

  [[nodiscard]] std::filesystem::path path_of(std::string_view name) const {
    return folder_ / name;
  }

  /// Returns the file that `name` refers to in the file `from`, relative to the model's folder.
  /// Backslashes count as slashes. If the file does not exist, tries only the last part of the
  /// name. Never returns a file outside the model's folder.
  [[nodiscard]] std::optional<std::string> resolve(std::string_view name,
                                                   const std::string& from) const {
    const std::filesystem::path base = std::filesystem::path(from).parent_path();
    const std::filesystem::path named = with_slashes(name);
    std::error_code error;
    for (const auto& path : {base / named, base / named.filename()}) {
      const std::filesystem::path plain = path.lexically_normal();
      if (!plain.has_filename() || plain.is_absolute() || *plain.begin() == "..") continue;
      if (std::filesystem::is_regular_file(folder_ / plain, error)) return plain.generic_string();
    }
    return std::nullopt;
  }

  /// @param from  the file that contains `name`, relative to the model's folder
  void add(std::string_view name, const std::string& from) {
    const auto found = resolve(name, from);
    if (!seen_.insert(found.value_or(std::string(name))).second) return;
    if (!found)
      result_.notes.push_back(fmt::format(
          "{} refers to '{}', which was not found in the model's folder and is not uploaded", from,
          name));
    else if (*found != model_name_)
      result_.files.push_back({*found, path_of(*found)});
  }

  References take() { return std::move(result_); }

 private:
  static std::string with_slashes(std::string_view name) {
    std::string text(name);
    std::replace(text.begin(), text.end(), '\\', '/');
    return text;
  }

  std::filesystem::path folder_;
  std::string model_name_;
  std::set<std::string> seen_;
  References result_;
};

// Returns the text after the options that are allowed between `map_Kd` and the file name. The table
// contains the minimum and maximum number of words after each option.
std::string_view skip_map_options(std::string_view rest) {
  static const std::map<std::string_view, std::pair<int, int>> kWords{
      {"-blendu", {1, 1}}, {"-blendv", {1, 1}}, {"-boost", {1, 1}},   {"-mm", {2, 2}},
      {"-o", {1, 3}},      {"-s", {1, 3}},      {"-t", {1, 3}},       {"-texres", {1, 1}},
      {"-clamp", {1, 1}},  {"-bm", {1, 1}},     {"-imfchan", {1, 1}}, {"-type", {1, 1}},
      {"-cc", {1, 1}}};
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789+-.eE") == std::string_view::npos;
  };
  for (;;) {
    const auto [option, after] = word(rest);
    const auto found = kWords.find(option);
    if (found == kWords.end()) return rest;
    rest = after;
    for (int i = 0; i < found->second.second; ++i) {
      const auto [value, next] = word(rest);
      if (i >= found->second.first && !is_number(value)) break;
      rest = next;
    }
  }
}

/// @param name  an existing material library, relative to the model's folder
void follow_mtl(const std::string& name, Collector& collector) {
  const auto text = read_text(collector.path_of(name), kMaxMtlBytes);
  if (!text) return;  // the worker reports the error
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    const auto [key, rest] = word(line);
    if (lower(std::string(key)) != "map_kd") continue;
    const std::string_view texture = unquote(skip_map_options(rest));
    if (!texture.empty()) collector.add(texture, name);
  }
}

void follow_mtllib(std::string_view names, const std::string& model, Collector& collector) {
  const auto follow = [&](std::string_view name) {
    collector.add(name, model);
    if (const auto found = collector.resolve(name, model)) follow_mtl(*found, collector);
  };
  // The line may be one name that contains spaces, or several names.
  if (collector.resolve(unquote(names), model)) return follow(unquote(names));
  for (auto [name, rest] = word(names); !name.empty(); std::tie(name, rest) = word(rest))
    follow(name);
}

Status follow_obj(const std::filesystem::path& path, Collector& collector) {
  // The file is read in pieces and split into lines, because an OBJ may be large although its
  // relevant lines are short.
  std::string line;
  const std::string model = path.filename().string();
  const auto take_line = [&] {
    const auto [key, rest] = word(line);
    if (key == "mtllib") follow_mtllib(rest, model, collector);
    line.clear();
  };
  HP_RETURN_IF_ERROR(read_file(path, 0, [&](std::string_view bytes) {
    for (const char c : bytes) {
      if (c == '\n' || c == '\r')
        take_line();
      else if (line.size() < 4096)
        line += c;
    }
    return true;
  }));
  take_line();
  return {};
}

std::string percent_decode(std::string_view text) {
  const auto digit = [](char c) {
    return std::string_view("0123456789abcdef")
        .find(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  };
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool coded =
        text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) < 16 && digit(text[i + 2]) < 16;
    result += coded ? static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2])) : text[i];
    if (coded) i += 2;
  }
  return result;
}

void follow_gltf_json(std::string_view text, const std::string& model, Collector& collector) {
  const auto json = parse_json(text, {.bytes = kMaxJsonBytes}).value_or(nullptr);
  for (const char* list : {"buffers", "images"}) {
    for (const auto& entry : json_at(json, list)) {
      const auto uri = json_string(entry, "uri");
      if (uri && !uri->starts_with("data:")) collector.add(percent_decode(*uri), model);
    }
  }
}

Status follow_gltf(const std::filesystem::path& path, Collector& collector) {
  HP_ASSIGN_OR_RETURN(const std::string text, read_text(path, kMaxJsonBytes));
  follow_gltf_json(text, path.filename().string(), collector);
  return {};
}

// A GLB starts with "glTF", version, length, followed by its JSON chunk: length, "JSON", bytes.
Status follow_glb(const std::filesystem::path& path, Collector& collector) {
  constexpr std::size_t kJsonStart = 20;
  std::string head;
  std::size_t end = kJsonStart;
  HP_RETURN_IF_ERROR(read_file(path, 0, [&](std::string_view bytes) {
    head += bytes;
    if (head.size() >= kJsonStart && end == kJsonStart) {
      std::uint64_t length = 0;
      for (std::size_t i = 0; i < 4; ++i)
        length |= std::uint64_t{static_cast<unsigned char>(head[12 + i])} << (8 * i);
      end = kJsonStart + std::min<std::uint64_t>(length, kMaxJsonBytes);
    }
    return head.size() < end;
  }));
  if (head.size() < end || !head.starts_with("glTF")) return {};
  follow_gltf_json(std::string_view(head).substr(kJsonStart, end - kJsonStart),
                   path.filename().string(), collector);
  return {};
}

Status follow_ply(const std::filesystem::path& path, Collector& collector) {
  std::string head;
  HP_RETURN_IF_ERROR(read_file(path, 0, [&](std::string_view bytes) {
    head += bytes;
    return std::ssize(head) < kMaxHeaderBytes && head.find("end_header") == std::string::npos;
  }));
  std::istringstream lines(head.substr(0, head.find("end_header")));
  for (std::string line; std::getline(lines, line);) {
    const auto [comment, rest] = word(line);
    const auto [key, name] = word(rest);
    if (comment == "comment" && key == "TextureFile")
      collector.add(unquote(name), path.filename().string());
  }
  return {};
}

}  // namespace

Result<References> find_references(const std::filesystem::path& model) {
  static const std::map<std::string, Status (*)(const std::filesystem::path&, Collector&)> kFollow{
      {".obj", follow_obj}, {".gltf", follow_gltf}, {".glb", follow_glb}, {".ply", follow_ply}};
  Collector collector(model);
  const auto follow = kFollow.find(lower(model.extension().string()));
  if (follow != kFollow.end()) HP_RETURN_IF_ERROR(follow->second(model, collector));
  return collector.take();
}

}  // namespace hydroprint::client
