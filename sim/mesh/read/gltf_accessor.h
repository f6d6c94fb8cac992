#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace tinygltf {
class Model;
}

namespace hydroprint::mesh {

/// A glTF accessor whose elements all lie within its buffer.
class GltfAccessor {
 public:
  /// @return nullopt if the accessor does not exist, is empty or sparse, or exceeds its buffer
  [[nodiscard]] static std::optional<GltfAccessor> open(const tinygltf::Model& model, int index);

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] int components() const { return components_; }
  /// Returns the components of element i, normalised if the file requires it; those beyond
  /// components() are 1.
  [[nodiscard]] std::array<double, 4> values(std::size_t i) const;
  /// Returns the first component of element i as an index; UINT32_MAX if it is not a valid index.
  [[nodiscard]] std::uint32_t index(std::size_t i) const;

 private:
  [[nodiscard]] double component(const unsigned char* at) const;

  const unsigned char* data_ = nullptr;
  std::size_t count_ = 0;
  std::size_t stride_ = 0;
  std::size_t component_bytes_ = 0;
  int components_ = 0;
  int component_type_ = 0;
  bool normalised_ = false;
};

}  // namespace hydroprint::mesh
