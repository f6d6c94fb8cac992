#include "sim/mesh/read/names.h"

#include <fmt/format.h>
#include <utf8proc.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <system_error>

#include "sim/base/utf8.h"

namespace hydroprint::mesh {
namespace {

namespace fs = std::filesystem;

/// Decodes UTF-8, or Latin-1 if the bytes are not UTF-8.
std::string utf8_of(std::string_view name) {
  const std::u32string decoded = decode_utf8(name);
  if (decoded.find(kReplacement) == decoded.npos) return std::string(name);
  std::u32string latin1;
  for (const char c : name) latin1 += static_cast<unsigned char>(c);
  return encode_utf8(latin1);
}

/// Returns the only file of `folder` with this key; nullopt if none or several have it.
std::optional<fs::path> only_file(const fs::path& folder, const std::string& key) {
  std::optional<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end;
       at.increment(error)) {
    if (name_key(at->path().filename().string()) != key || !at->is_regular_file(error)) continue;
    if (found) return {};
    found = folder / at->path().filename();
  }
  return found;
}

}  // namespace

std::string name_key(std::string_view name) {
  const std::string text = utf8_of(name);
  utf8proc_uint8_t* folded = nullptr;
  const auto options =
      static_cast<utf8proc_option_t>(UTF8PROC_STABLE | UTF8PROC_COMPOSE | UTF8PROC_CASEFOLD);
  const auto size = utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(text.data()),
                                 static_cast<utf8proc_ssize_t>(text.size()), &folded, options);
  const std::unique_ptr<utf8proc_uint8_t, decltype(&std::free)> owned(folded, std::free);
  if (size < 0) return text;
  return {reinterpret_cast<const char*>(folded), static_cast<std::size_t>(size)};
}

fs::path resolve_texture(const fs::path& folder, std::string name) {
  const auto begin = name.find_first_not_of(" \t\"");
  const auto end = name.find_last_not_of(" \t\r\"");
  if (begin == name.npos) return {};
  name = name.substr(begin, end - begin + 1);
  const auto as_named = folder / name;
  std::replace(name.begin(), name.end(), '\\', '/');
  std::error_code error;
  for (const auto& path : {as_named, folder / name, folder / fs::path(name).filename()})
    if (fs::is_regular_file(path, error)) return path;
  return as_named;
}

std::optional<fs::path> similar_file(const fs::path& missing, const fs::path& folder) {
  std::string name = missing.string();
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path wanted(name);
  const std::string key = name_key(wanted.filename().string());
  if (auto beside = only_file(wanted.parent_path(), key)) return beside;
  return only_file(folder, key);
}

Warning similar_name(const fs::path& missing, const fs::path& found, const fs::path& model) {
  return {WarningCode::SIMILAR_NAME,
          fmt::format("the file {} is missing; {} was used instead, because only upper and lower "
                      "case or the Unicode form of the names differ",
                      one_line(missing.filename().string()), one_line(found.filename().string())),
          {InFile{model.string()}}};
}

}  // namespace hydroprint::mesh
