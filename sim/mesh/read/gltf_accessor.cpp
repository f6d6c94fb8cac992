#include "sim/mesh/read/gltf_accessor.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>

namespace hydroprint::mesh {
namespace {

template <class T>
T load(const unsigned char* at) {
  T value{};
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// An array of elements as a file announces it.
struct Announced {
  int view = -1;
  std::size_t offset = 0;
  std::size_t count = 0;
  int component_type = 0;
  int components = 0;
  std::size_t stride = 0;  ///< 0: elements follow each other
};

/// Finds the elements in their buffer; nullopt if they exceed it.
std::optional<GltfElements> locate(const tinygltf::Model& model, const Announced& announced) {
  const auto* view = entry(model.bufferViews, announced.view);
  const auto* buffer = view == nullptr ? nullptr : entry(model.buffers, view->buffer);
  const int bytes =
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(announced.component_type));
  if (buffer == nullptr || bytes <= 0 || announced.components <= 0 || announced.components > 4)
    return {};
  const auto element = static_cast<std::size_t>(bytes * announced.components);
  const std::size_t step = announced.stride == 0 ? element : announced.stride;
  const std::size_t size = buffer->data.size();
  if (step < element || view->byteOffset > size || view->byteLength > size - view->byteOffset ||
      announced.offset > view->byteLength)
    return {};
  const std::size_t room = view->byteLength - announced.offset;
  if (room < element || (room - element) / step + 1 < announced.count) return {};
  return GltfElements{buffer->data.data() + view->byteOffset + announced.offset,
                      announced.count,
                      step,
                      announced.component_type,
                      static_cast<std::size_t>(bytes),
                      announced.components};
}

std::uint32_t load_index(const GltfElements& elements, std::size_t i) {
  const auto* at = elements.at(i);
  switch (elements.component_type) {
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

/// Largest number of elements that are zero except for sparse ones: the file needs no room for
/// them, so its size does not limit it.
constexpr std::size_t kMaxZeros = 4'000'000;

}  // namespace

std::optional<GltfAccessor> GltfAccessor::open(const tinygltf::Model& model, int index) {
  const auto* accessor = entry(model.accessors, index);
  if (accessor == nullptr || accessor->count == 0) return {};
  const int components =
      tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor->type));
  GltfAccessor result;
  result.normalised_ = accessor->normalized;
  const auto* view = entry(model.bufferViews, accessor->bufferView);
  if (view == nullptr) {
    if (!accessor->sparse.isSparse || accessor->bufferView >= 0 || accessor->count > kMaxZeros ||
        components <= 0 || components > 4)
      return {};
    result.dense_ = {nullptr, accessor->count, 0, accessor->componentType, 0, components};
  } else {
    const int stride = accessor->ByteStride(*view);
    if (stride <= 0) return {};
    const auto found =
        locate(model, {accessor->bufferView, accessor->byteOffset, accessor->count,
                       accessor->componentType, components, static_cast<std::size_t>(stride)});
    if (!found) return {};
    result.dense_ = *found;
  }
  if (accessor->sparse.isSparse && !result.open_sparse(model, index)) return {};
  return result;
}

bool GltfAccessor::open_sparse(const tinygltf::Model& model, int index) {
  const auto& accessor = model.accessors[static_cast<std::size_t>(index)];
  const auto& sparse = accessor.sparse;
  if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    return false;
  if (sparse.count == 0) return true;
  const auto count = static_cast<std::size_t>(sparse.count);
  const auto indices =
      locate(model, {sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                     count, sparse.indices.componentType, 1, 0});
  const auto values =
      locate(model, {sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                     count, accessor.componentType, dense_.components, 0});
  if (!indices || !values) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t here = load_index(*indices, i);
    if (here >= size() || (i > 0 && here <= load_index(*indices, i - 1))) return false;
  }
  sparse_indices_ = *indices;
  sparse_values_ = *values;
  dense_.component_bytes = values->component_bytes;
  return true;
}

const unsigned char* GltfAccessor::element(std::size_t i) const {
  std::size_t low = 0;
  std::size_t high = sparse_indices_.count;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (load_index(sparse_indices_, middle) < i)
      low = middle + 1;
    else
      high = middle;
  }
  if (low < sparse_indices_.count && load_index(sparse_indices_, low) == i)
    return sparse_values_.at(low);
  return dense_.data == nullptr ? nullptr : dense_.at(i);
}

double GltfAccessor::component(const unsigned char* at) const {
  const auto scaled = [&](double value, double largest) {
    return normalised_ ? std::max(value / largest, -1.0) : value;
  };
  switch (dense_.component_type) {
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
  const auto* at = element(i);
  for (int k = 0; k < dense_.components; ++k)
    result[static_cast<std::size_t>(k)] =
        at == nullptr ? 0 : component(at + static_cast<std::size_t>(k) * dense_.component_bytes);
  return result;
}

std::uint32_t GltfAccessor::index(std::size_t i) const {
  const auto* at = element(i);
  if (at == nullptr) return 0;
  GltfElements one = dense_;
  one.data = at;
  return load_index(one, 0);
}

}  // namespace hydroprint::mesh
