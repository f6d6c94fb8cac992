#include "sim/sample/icosphere.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>

namespace hydroprint::sample {
namespace {

/// Unit icosahedron that stands on a corner: a pole, two rings of five vertices, and a pole.
mesh::Model icosahedron() {
  mesh::Model model;
  const double z = 1 / std::sqrt(5.0);
  const double r = 2 / std::sqrt(5.0);
  model.vertices.emplace_back(0, 0, -1);
  for (int ring = 0; ring < 2; ++ring)
    for (int i = 0; i < 5; ++i) {
      const double angle = (2 * i + ring) * std::numbers::pi / 5;
      model.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), ring == 0 ? -z : z);
    }
  model.vertices.emplace_back(0, 0, 1);
  for (int i = 0; i < 5; ++i) {
    const int j = (i + 1) % 5;
    model.triangles.emplace_back(0, 1 + j, 1 + i);
    model.triangles.emplace_back(1 + i, 1 + j, 6 + i);
    model.triangles.emplace_back(1 + j, 6 + j, 6 + i);
    model.triangles.emplace_back(6 + i, 6 + j, 11);
  }
  return model;
}

class Halver {
 public:
  explicit Halver(mesh::Model& model) : model_(model) {}

  void run() {
    std::vector<Eigen::Vector3i> finer;
    finer.reserve(4 * model_.triangles.size());
    for (const auto& t : model_.triangles) {
      const int ab = middle(t[0], t[1]);
      const int bc = middle(t[1], t[2]);
      const int ca = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
    }
    model_.triangles.swap(finer);
  }

 private:
  int middle(int a, int b) {
    const auto key = static_cast<std::uint64_t>(std::min(a, b)) << 32 |
                     static_cast<std::uint64_t>(std::max(a, b));
    const auto [entry, is_new] =
        middles_.try_emplace(key, static_cast<int>(model_.vertices.size()));
    if (is_new) {
      const Eigen::Vector3d sum = model_.vertices[static_cast<std::size_t>(a)] +
                                  model_.vertices[static_cast<std::size_t>(b)];
      model_.vertices.push_back(sum.normalized());
    }
    return entry->second;
  }

  mesh::Model& model_;
  std::unordered_map<std::uint64_t, int> middles_;
};

}  // namespace

mesh::Model icosphere(double radius_mm, int subdivisions) {
  mesh::Model model = icosahedron();
  for (int i = 0; i < subdivisions; ++i) Halver(model).run();
  for (auto& v : model.vertices) v *= radius_mm;
  model.path = "icosphere";
  return model;
}

}  // namespace hydroprint::sample
