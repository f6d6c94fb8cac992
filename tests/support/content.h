#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace hydroprint::testing {

/// Content of a file; empty if it does not exist.
[[nodiscard]] inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace hydroprint::testing
