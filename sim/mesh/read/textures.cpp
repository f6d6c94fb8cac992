#include "sim/mesh/read/textures.h"

#include <algorithm>
#include <system_error>

namespace hydroprint::mesh {

std::filesystem::path resolve_texture(const std::filesystem::path& folder, std::string name) {
  const auto begin = name.find_first_not_of(" \t\"");
  const auto end = name.find_last_not_of(" \t\r\"");
  if (begin == name.npos) return {};
  name = name.substr(begin, end - begin + 1);
  const auto as_named = folder / name;
  std::replace(name.begin(), name.end(), '\\', '/');
  std::error_code error;
  for (const auto& path :
       {as_named, folder / name, folder / std::filesystem::path(name).filename()})
    if (std::filesystem::is_regular_file(path, error)) return path;
  return as_named;
}

}  // namespace hydroprint::mesh
