#pragma once

#include <cstddef>
#include <vector>

namespace hydroprint::mesh {

/// Returns the entry of a glTF array; nullptr if the file has none with this index.
template <class T>
const T* entry(const std::vector<T>& values, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= values.size()) return nullptr;
  return &values[static_cast<std::size_t>(index)];
}

}  // namespace hydroprint::mesh
