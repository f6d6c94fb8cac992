#include "sim/waterline/level_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "sim/base/check.h"

namespace hydroprint::waterline {
namespace {

/// The sums that describe a face.
struct Sums {
  std::vector<std::size_t> triangles;
  double area_mm2 = 0;
  double perimeter_mm = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< integral of the position, mm3
};

Eigen::Vector3d area_vector(const Body& body, const Eigen::Vector3i& t) {
  const Eigen::Vector3d& a = body.points_mm[t[0]];
  return 0.5 * (body.points_mm[t[1]] - a).cross(body.points_mm[t[2]] - a);
}

Eigen::Vector3d middle_of(const Body& body, const Eigen::Vector3i& t) {
  return (body.points_mm[t[0]] + body.points_mm[t[1]] + body.points_mm[t[2]]) / 3;
}

bool is_level_and_down(const Body& body, const Eigen::Vector3i& t, double slope_rad) {
  const Eigen::Vector3d area = area_vector(body, t);
  return area.z() < 0 && area.head<2>().norm() < std::sin(slope_rad) * area.norm();
}

/// For each edge between level triangles or at their border: the first of them, and whether there
/// is a second.
struct Edge {
  std::size_t triangle = 0;
  bool is_inside = false;
};
using Edges = std::map<std::pair<int, int>, Edge>;

/// Unites triangles that share an edge.
Edges unite(const Body& body, const std::vector<std::size_t>& level,
            boost::disjoint_sets_with_storage<>& faces) {
  Edges edges;
  for (const std::size_t t : level) {
    for (int i = 0; i < 3; ++i) {
      const auto ends = std::minmax({body.triangles[t][i], body.triangles[t][(i + 1) % 3]});
      const auto [edge, is_new] = edges.try_emplace(ends, Edge{t, false});
      if (is_new) continue;
      edge->second.is_inside = true;
      faces.union_set(t, edge->second.triangle);
    }
  }
  return edges;
}

LevelFace face_of(const Body& body, const Sums& sums) {
  const Eigen::Vector3d centre = sums.moment / sums.area_mm2;
  LevelFace face{centre.z(), {}, sums.area_mm2};
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t t : sums.triangles) {
    const Eigen::Vector3d middle = middle_of(body, body.triangles[t]);
    const double distance = (middle - centre).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    face.place_mm = middle.head<2>();
  }
  return face;
}

}  // namespace

std::vector<LevelFace> find_level_faces(const Body& body, const std::vector<char>& counted,
                                        double slope_rad) {
  HP_CHECK(counted.size() == body.triangles.size());
  std::vector<std::size_t> level;
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    if (counted[t] != 0 && is_level_and_down(body, body.triangles[t], slope_rad))
      level.push_back(t);
  }
  boost::disjoint_sets_with_storage<> faces(body.triangles.size());
  const Edges edges = unite(body, level, faces);
  std::map<std::size_t, Sums> sums;  // by face
  for (const std::size_t t : level) {
    Sums& face = sums[faces.find_set(t)];
    const double area_mm2 = area_vector(body, body.triangles[t]).norm();
    face.triangles.push_back(t);
    face.area_mm2 += area_mm2;
    face.moment += area_mm2 * middle_of(body, body.triangles[t]);
  }
  for (const auto& [ends, edge] : edges) {
    if (edge.is_inside) continue;
    sums[faces.find_set(edge.triangle)].perimeter_mm +=
        (body.points_mm[ends.first] - body.points_mm[ends.second]).norm();
  }
  std::vector<LevelFace> out;
  for (const auto& [root, face] : sums) {
    if (face.area_mm2 >= kCapillaryLength_mm * face.perimeter_mm)
      out.push_back(face_of(body, face));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const LevelFace& a, const LevelFace& b) { return a.area_mm2 > b.area_mm2; });
  return out;
}

}  // namespace hydroprint::waterline
