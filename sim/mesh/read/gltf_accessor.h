#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tinygltf {
class Model;
}

namespace hydroprint::mesh {

/// Returns the entry of a glTF array; nullptr if the file has none with this index.
template <class T>
const T* entry(const std::vector<T>& values, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= values.size()) return nullptr;
  return &values[static_cast<std::size_t>(index)];
}

/// Elements in a buffer, all of which lie within it.
struct GltfElements {
  const unsigned char* data = nullptr;  ///< nullptr: all components are zero
  std::size_t count = 0;
  std::size_t stride = 0;  ///< bytes from one element to the next
  int component_type = 0;  ///< a TINYGLTF_COMPONENT_TYPE_ value
  std::size_t component_bytes = 0;
  int components = 0;

  [[nodiscard]] const unsigned char* at(std::size_t i) const { return data + i * stride; }
};

/// A glTF accessor whose elements all lie within its buffers, sparse or not.
class GltfAccessor {
 public:
  /// @return nullopt if the accessor does not exist, is empty, exceeds a buffer, or if the indices
  ///         of its sparse values do not increase or exceed its size
  [[nodiscard]] static std::optional<GltfAccessor> open(const tinygltf::Model& model, int index);

  [[nodiscard]] std::size_t size() const { return dense_.count; }
  [[nodiscard]] int components() const { return dense_.components; }
  /// Reads integers as normalised even if the file does not say so, as some exporters omit it for
  /// colours.
  void normalise() { normalised_ = true; }
  /// Returns the components of element i, normalised if the file requires it; those beyond
  /// components() are 1.
  [[nodiscard]] std::array<double, 4> values(std::size_t i) const;
  /// Returns the first component of element i as an index; UINT32_MAX if it is not a valid index.
  [[nodiscard]] std::uint32_t index(std::size_t i) const;

 private:
  [[nodiscard]] bool open_sparse(const tinygltf::Model& model, int index);
  /// Returns the bytes of element i; nullptr if its components are zero.
  [[nodiscard]] const unsigned char* element(std::size_t i) const;
  [[nodiscard]] double component(const unsigned char* at) const;

  GltfElements dense_;
  GltfElements sparse_indices_;  ///< ascending; count 0: not sparse
  GltfElements sparse_values_;
  bool normalised_ = false;
};

}  // namespace hydroprint::mesh
