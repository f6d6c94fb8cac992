#include "sim/mesh/read/gltf_accessor.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>

namespace hydroprint::mesh {
namespace {

template <class T>
const T* entry(const std::vector<T>& values, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= values.size()) return nullptr;
  return &values[static_cast<std::size_t>(index)];
}

template <class T>
T load(const unsigned char* at) {
  T value{};
  std::memcpy(&value, at, sizeof value);
  return value;
}

}  // namespace

std::optional<GltfAccessor> GltfAccessor::open(const tinygltf::Model& model, int index) {
  const auto* accessor = entry(model.accessors, index);
  if (accessor == nullptr || accessor->sparse.isSparse || accessor->count == 0) return {};
  const auto* view = entry(model.bufferViews, accessor->bufferView);
  if (view == nullptr) return {};
  const auto* buffer = entry(model.buffers, view->buffer);
  const int bytes =
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor->componentType));
  const int components =
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor->type));
  const int stride = accessor->ByteStride(*view);
  if (buffer == nullptr || bytes <= 0 || components <= 0 || components > 4 ||
      stride < bytes * components)
    return {};

  const std::size_t size = buffer->data.size();
  if (view->byteOffset > size || view->byteLength > size - view->byteOffset) return {};
  if (accessor->byteOffset > view->byteLength) return {};
  const std::size_t room = view->byteLength - accessor->byteOffset;
  const auto element = static_cast<std::size_t>(bytes * components);
  const auto step = static_cast<std::size_t>(stride);
  if (room < element || (room - element) / step + 1 < accessor->count) return {};

  GltfAccessor result;
  result.data_ = buffer->data.data() + view->byteOffset + accessor->byteOffset;
  result.count_ = accessor->count;
  result.stride_ = step;
  result.component_bytes_ = static_cast<std::size_t>(bytes);
  result.components_ = components;
  result.component_type_ = accessor->componentType;
  result.normalised_ = accessor->normalized;
  return result;
}

double GltfAccessor::component(const unsigned char* at) const {
  const auto scaled = [&](double value, double largest) {
    return normalised_ ? std::max(value / largest, -1.0) : value;
  };
  switch (component_type_) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(load<std::int8_t>(at), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(*at, 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(load<std::int16_t>(at), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(load<std::uint16_t>(at), 65535);
    case TINYGLTF_COMPONENT_TYPE_INT:
      return load<std::int32_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<std::uint32_t>(at);
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return load<float>(at);
    default:
      return load<double>(at);
  }
}

std::array<double, 4> GltfAccessor::values(std::size_t i) const {
  std::array<double, 4> result = {1, 1, 1, 1};
  for (int k = 0; k < components_; ++k)
    result[static_cast<std::size_t>(k)] =
        component(data_ + i * stride_ + static_cast<std::size_t>(k) * component_bytes_);
  return result;
}

std::uint32_t GltfAccessor::index(std::size_t i) const {
  const auto* at = data_ + i * stride_;
  switch (component_type_) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *at;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<std::uint32_t>(at);
    default:
      return UINT32_MAX;
  }
}

}  // namespace hydroprint::mesh
