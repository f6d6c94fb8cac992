#include "sim/display/thin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

namespace hydroprint::display {
namespace {

constexpr int kMostTries = 12;

double area_mm2(const CornerMesh& mesh, const Eigen::Vector3i& t) {
  const Eigen::Vector3d a = mesh.corners[t[0]].position.cast<double>();
  const Eigen::Vector3d ab = mesh.corners[t[1]].position.cast<double>() - a;
  const Eigen::Vector3d ac = mesh.corners[t[2]].position.cast<double>() - a;
  return ab.cross(ac).norm() / 2;
}

double area_mm2(const CornerMesh& mesh) {
  double sum = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) sum += area_mm2(mesh, t);
  return sum;
}

/// Disjoint sets of numbers.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int find(int i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  void unite(int a, int b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// The sets into which a grid divides a mesh.
struct Clusters {
  Sets places;   ///< of places that become one
  Sets corners;  ///< of corners that become one
};

using Cell = Eigen::Vector3i;

std::vector<Cell> cells_of(const CornerMesh& mesh, double edge_mm) {
  std::vector<Cell> out(mesh.corners.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Eigen::Vector3d at = mesh.corners[i].position.cast<double>() / edge_mm;
    out[i] = at.array().floor().cast<int>();
  }
  return out;
}

Clusters cluster(const CornerMesh& mesh, double edge_mm) {
  Clusters out{Sets(mesh.places), Sets(mesh.corners.size())};
  const std::vector<Cell> cells = cells_of(mesh, edge_mm);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (cells[a] != cells[b]) continue;
      out.corners.unite(a, b);
      out.places.unite(mesh.place[a], mesh.place[b]);
    }
  }
  return out;
}

/// Returns whether the places of a triangle stay three.
bool remains(const CornerMesh& mesh, const Eigen::Vector3i& t, Sets& places) {
  const int a = places.find(mesh.place[t[0]]);
  const int b = places.find(mesh.place[t[1]]);
  const int c = places.find(mesh.place[t[2]]);
  return a != b && b != c && c != a;
}

std::size_t count_remaining(const CornerMesh& mesh, Clusters& clusters) {
  return static_cast<std::size_t>(std::ranges::count_if(
      mesh.triangles, [&](const auto& t) { return remains(mesh, t, clusters.places); }));
}

/// Returns the clusters of the finest grid tried with at most `most` triangles. Cells of edge h cut
/// a surface of area A into about 2 A / h^2 triangles.
Result<Clusters> find_clusters(const CornerMesh& mesh, std::size_t most, const Context& context) {
  double edge_mm = std::sqrt(2 * area_mm2(mesh) / static_cast<double>(most));
  Eigen::AlignedBox3f box;
  for (const Corner& corner : mesh.corners) box.extend(corner.position);
  edge_mm = std::max(edge_mm, 1e-6 * static_cast<double>(box.diagonal().norm()));
  for (int i = 0; i < kMostTries; ++i) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    Clusters out = cluster(mesh, edge_mm);
    const std::size_t count = count_remaining(mesh, out);
    if (count <= most) return out;
    edge_mm *= 1.03 * std::sqrt(static_cast<double>(count) / static_cast<double>(most));
  }
  return cluster(mesh, 4 * static_cast<double>(box.diagonal().norm()));
}

/// A mean of corners.
struct Mean {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  Eigen::Vector3d colour = Eigen::Vector3d::Zero();
  int count = 0;

  void add(const Corner& c) {
    position += c.position.cast<double>();
    uv += c.uv.cast<double>();
    colour += c.colour.cast<double>();
    ++count;
  }
};

/// Returns the corners of the clusters at their roots; other entries are unchanged.
std::vector<Corner> mean_corners(const CornerMesh& mesh, Clusters& clusters) {
  std::vector<Mean> of_place(mesh.places), of_corner(mesh.corners.size());
  std::vector<bool> is_counted(mesh.places, false);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    of_corner[clusters.corners.find(static_cast<int>(i))].add(mesh.corners[i]);
    if (is_counted[mesh.place[i]]) continue;
    is_counted[mesh.place[i]] = true;
    of_place[clusters.places.find(mesh.place[i])].add(mesh.corners[i]);
  }
  std::vector<Corner> out = mesh.corners;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Mean& mean = of_corner[i];
    if (mean.count == 0) continue;
    const Mean& place = of_place[clusters.places.find(mesh.place[i])];
    out[i].position = (place.position / place.count).cast<float>();
    out[i].uv = (mean.uv / mean.count).cast<float>();
    out[i].colour = (mean.colour / mean.count).cast<float>();
  }
  return out;
}

/// Keeps the corners that the triangles use, and numbers them and their places in order of use.
void drop_unused(CornerMesh& mesh) {
  std::vector<int> corner_number(mesh.corners.size(), -1), place_number(mesh.places, -1);
  std::vector<Corner> corners;
  std::vector<int> places;
  mesh.places = 0;
  for (Eigen::Vector3i& t : mesh.triangles) {
    for (int& corner : t) {
      int& place = place_number[mesh.place[corner]];
      if (place < 0) place = mesh.places++;
      if (corner_number[corner] < 0) {
        corner_number[corner] = static_cast<int>(corners.size());
        corners.push_back(mesh.corners[corner]);
        places.push_back(place);
      }
      corner = corner_number[corner];
    }
  }
  mesh.corners = std::move(corners);
  mesh.place = std::move(places);
}

struct HashOfThree {
  std::size_t operator()(const Eigen::Vector3i& t) const {
    std::uint64_t sum = 0;
    for (const int i : t) sum = (sum ^ static_cast<std::uint32_t>(i)) * 0x9e3779b97f4a7c15;
    return sum ^ (sum >> 31);
  }
};

/// Returns the triangle that begins with its smallest corner and turns the same way.
Eigen::Vector3i turned(const Eigen::Vector3i& t) {
  int first = 0;
  t.minCoeff(&first);
  return {t[first], t[(first + 1) % 3], t[(first + 2) % 3]};
}

Eigen::Vector3i roots_of(const Eigen::Vector3i& t, Sets& sets) {
  return {sets.find(t[0]), sets.find(t[1]), sets.find(t[2])};
}

/// The triangles that clusters leave.
struct Collapsed {
  CornerMesh mesh;
  double area_mm2 = 0;  ///< counted once where triangles of several materials coincide
};

Collapsed collapse(const CornerMesh& mesh, Clusters& clusters) {
  Collapsed out;
  out.mesh.corners = mean_corners(mesh, clusters);
  out.mesh.places = mesh.places;
  for (const int place : mesh.place) out.mesh.place.push_back(clusters.places.find(place));
  using Seen = std::unordered_set<Eigen::Vector3i, HashOfThree>;
  Seen seen_corners, seen_places;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    if (!remains(mesh, t, clusters.places)) continue;
    const Eigen::Vector3i corners = roots_of(t, clusters.corners);
    if (!seen_corners.insert(turned(corners)).second) continue;
    out.mesh.triangles.push_back(corners);
    out.mesh.ink.push_back(mesh.ink[i]);
    const auto place = [&](int corner) { return out.mesh.place[corner]; };
    const Eigen::Vector3i places(place(corners[0]), place(corners[1]), place(corners[2]));
    if (seen_places.insert(turned(places)).second) out.area_mm2 += area_mm2(out.mesh, corners);
  }
  drop_unused(out.mesh);
  return out;
}

/// Returns these triangles, in the order of the mesh.
CornerMesh part_of(const CornerMesh& mesh, std::vector<int> triangles) {
  std::ranges::sort(triangles);
  CornerMesh out = mesh;
  out.triangles.clear();
  out.ink.clear();
  for (const int i : triangles) {
    out.triangles.push_back(mesh.triangles[i]);
    out.ink.push_back(mesh.ink[i]);
  }
  drop_unused(out);
  return out;
}

/// A number that looks random, always the same for the same index.
std::uint64_t shuffled(std::uint64_t index) {
  index = (index ^ (index >> 31)) * 0x9e3779b97f4a7c15;
  return index ^ (index >> 29);
}

/// Returns the `most` largest triangles, in their order. Among triangles of nearly the same size
/// the choice is random, so that it is spread evenly.
CornerMesh largest(const CornerMesh& mesh, std::size_t most) {
  using Rank = std::tuple<int, std::uint64_t, int>;
  std::vector<Rank> ranks;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    int doublings = 0;
    std::frexp(area_mm2(mesh, mesh.triangles[i]), &doublings);
    ranks.emplace_back(-doublings, shuffled(i), static_cast<int>(i));
  }
  std::ranges::nth_element(ranks, ranks.begin() + static_cast<std::ptrdiff_t>(most));
  std::vector<int> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(std::get<2>(ranks[i]));
  return part_of(mesh, std::move(chosen));
}

}  // namespace

Result<Thinned> thin(CornerMesh mesh, std::size_t most, const Context& context) {
  if (mesh.triangles.size() <= most) return Thinned{std::move(mesh), false};
  HP_ASSIGN_OR_RETURN(Clusters clusters, find_clusters(mesh, most, context));
  Collapsed out = collapse(mesh, clusters);
  if (2 * out.area_mm2 >= area_mm2(mesh)) return Thinned{std::move(out.mesh), false};
  return Thinned{largest(mesh, most), true};
}

}  // namespace hydroprint::display
