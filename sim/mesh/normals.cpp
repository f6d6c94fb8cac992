#include "sim/mesh/normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/base/check.h"
#include "sim/mesh/groups.h"

namespace hydroprint::mesh {
namespace {

const double kCosCrease = std::sqrt(3.0) / 2;  // 30 degrees

const Eigen::Vector3d& at(const std::vector<Eigen::Vector3d>& points, int i) {
  return points[static_cast<std::size_t>(i)];
}

constexpr std::size_t kChunk = 8192;  ///< faces processed together

/// Normal and corner angles of each face.
struct Faces {
  std::vector<Eigen::Vector3d> normals;
  std::vector<std::array<double, 3>> angles_rad;
};

double angle(const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

Result<Faces> measure(const std::vector<Eigen::Vector3d>& points,
                      const std::vector<Eigen::Vector3i>& triangles, const Context& context) {
  Faces faces;
  faces.normals.resize(triangles.size());
  faces.angles_rad.resize(triangles.size());
  const std::size_t chunks = (triangles.size() + kChunk - 1) / kChunk;
  HP_RETURN_IF_ERROR(parallel_for(context, "", chunks, [&](std::size_t c) -> Status {
    const std::size_t last = std::min((c + 1) * kChunk, triangles.size());
    for (std::size_t t = c * kChunk; t < last; ++t) {
      const Eigen::Vector3i& corners = triangles[t];
      const auto& a = at(points, corners[0]);
      const std::array<Eigen::Vector3d, 3> side = {at(points, corners[1]) - a,
                                                   at(points, corners[2]) - at(points, corners[1]),
                                                   a - at(points, corners[2])};
      faces.normals[t] = side[0].cross(-side[2]).stableNormalized();
      for (std::size_t k = 0; k < 3; ++k) {
        faces.angles_rad[t][k] = angle(side[k], -side[(k + 2) % 3]);
      }
    }
    return {};
  }));
  return faces;
}

/// Groups corners that share a normal. A corner has the number of the side that begins at the
/// corner.
Groups smooth_corners(const std::vector<Eigen::Vector3i>& triangles, const std::vector<int>& weld,
                      const Edges& edges, const std::vector<Eigen::Vector3d>& normals) {
  HP_CHECK(normals.size() == triangles.size());
  const auto next = [](int side) { return side % 3 == 2 ? side - 2 : side + 1; };
  Groups groups(3 * triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() != 2) continue;
    const int a = sides[0];
    const int b = sides[1];
    // Faces with the same direction along their common edge face opposite sides, which is not
    // possible on a smooth surface.
    if (side_ends(a, triangles, weld).from == side_ends(b, triangles, weld).from) continue;
    const double cosine =
        normals[static_cast<std::size_t>(a / 3)].dot(normals[static_cast<std::size_t>(b / 3)]);
    if (!(cosine > kCosCrease)) continue;
    groups.join(static_cast<std::size_t>(a), static_cast<std::size_t>(next(b)));
    groups.join(static_cast<std::size_t>(next(a)), static_cast<std::size_t>(b));
  }
  return groups;
}

}  // namespace

Result<std::vector<std::array<Eigen::Vector3d, 3>>> corner_normals(
    const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3i>& triangles,
    const std::vector<int>& weld, const Edges& edges, const Context& context) {
  HP_CHECK(weld.size() == points.size());
  HP_ASSIGN_OR_RETURN(const Faces faces, measure(points, triangles, context));
  const auto& normals = faces.normals;
  auto groups = smooth_corners(triangles, weld, edges, normals);

  std::vector<Eigen::Vector3d> sums(3 * triangles.size(), Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      sums[groups.find(3 * t + k)] += faces.angles_rad[t][k] * normals[t];
    }
  }

  std::vector<std::array<Eigen::Vector3d, 3>> result(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& sum = sums[groups.find(3 * t + k)];
      // The normals around a full ring of faces may cancel. In that case the face's own normal is
      // used.
      result[t][k] = sum.norm() > 1e-6 ? sum.normalized() : normals[t];
    }
  }
  return result;
}

}  // namespace hydroprint::mesh
