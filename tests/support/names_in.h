#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace hydroprint::testing {

/// Names of the entries of a folder.
[[nodiscard]] inline std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename());
  }
  return names;
}

}  // namespace hydroprint::testing
