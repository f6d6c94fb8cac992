#include "sim/display/corners.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

namespace hydroprint::display {
namespace {

/// Numbers equal keys alike, from 0 in order of first appearance: a hash table with open
/// addressing, because there are millions of keys.
template <std::size_t kWords>
class Numbers {
 public:
  using Key = std::array<std::uint32_t, kWords>;

  /// @param most  maximum number of different keys
  explicit Numbers(std::size_t most) : slots_(std::bit_ceil(2 * most + 1), -1) {}
  /// @return the key's number, and whether it is new
  std::pair<int, bool> operator()(const Key& key) {
    std::size_t slot = hash(key) & (slots_.size() - 1);
    while (slots_[slot] >= 0) {
      if (keys_[slots_[slot]] == key) return {slots_[slot], false};
      slot = (slot + 1) & (slots_.size() - 1);
    }
    slots_[slot] = size();
    keys_.push_back(key);
    return {slots_[slot], true};
  }
  [[nodiscard]] int size() const { return static_cast<int>(keys_.size()); }

 private:
  static std::size_t hash(const Key& key) {
    std::uint64_t sum = 0xcbf29ce484222325;
    for (const std::uint32_t word : key) {
      sum = (sum ^ word) * 0x9e3779b97f4a7c15;
      sum ^= sum >> 29;
    }
    return sum;
  }

  std::vector<int> slots_;
  std::vector<Key> keys_;
};

/// -0 and 0 are the same number.
std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value == 0 ? 0.0F : value); }

/// Returns the corner k of triangle t.
Corner corner_of(const mesh::Model& model, const image::Paint& paint, std::size_t t, int k,
                 const Eigen::Vector3d& origin_mm) {
  const int vertex = model.triangles[t][k];
  Corner out;
  out.position = (model.vertices[vertex] - origin_mm).cast<float>();
  if (!model.corner_uvs.empty() && model.corner_uvs[t][k].allFinite())
    out.uv = model.corner_uvs[t][k];
  out.ink = paint.ink_index(t);
  if (!paint.ink(t).of_surface) return out;
  if (!paint.vertex_colours().empty()) {
    out.colour = paint.vertex_colours()[vertex];
  } else if (!paint.triangle_colours().empty()) {
    out.colour = paint.triangle_colours()[t];
  }
  return out;
}

Numbers<3>::Key place_key(const Corner& c) {
  return {bits(c.position.x()), bits(c.position.y()), bits(c.position.z())};
}

Numbers<7>::Key corner_key(const Corner& c, int place) {
  return {static_cast<std::uint32_t>(place),
          static_cast<std::uint32_t>(c.ink),
          bits(c.uv.x()),
          bits(c.uv.y()),
          bits(c.colour.x()),
          bits(c.colour.y()),
          bits(c.colour.z())};
}

}  // namespace

CornerMesh find_corners(const mesh::Model& model, const image::Paint& paint,
                        const Eigen::Vector3d& origin_mm) {
  CornerMesh out;
  out.triangles.reserve(model.triangles.size());
  out.ink.reserve(model.triangles.size());
  Numbers<3> places(std::min(model.vertices.size(), 3 * model.triangles.size()));
  Numbers<7> corners(3 * model.triangles.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    Eigen::Vector3i triangle;
    for (int k = 0; k < 3; ++k) {
      const Corner corner = corner_of(model, paint, t, k, origin_mm);
      const int place = places(place_key(corner)).first;
      const auto [number, is_new] = corners(corner_key(corner, place));
      triangle[k] = number;
      if (!is_new) continue;
      out.corners.push_back(corner);
      out.place.push_back(place);
    }
    out.triangles.push_back(triangle);
    out.ink.push_back(paint.ink_index(t));
  }
  out.places = places.size();
  return out;
}

}  // namespace hydroprint::display
