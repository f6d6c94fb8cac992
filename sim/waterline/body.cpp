#include "sim/waterline/body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/check.h"

namespace hydroprint::waterline {

Body place(const mesh::Surface& surface, Pose& X_FO) {
  HP_CHECK(!surface.triangles.empty());
  HP_CHECK(surface.weld.size() == surface.points.size());
  HP_CHECK(surface.corner_normals.size() == surface.triangles.size());
  Body body;
  body.points_mm.reserve(surface.points.size());
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  X_FO.translation().z() = 0;
  for (const Eigen::Vector3d& p : surface.points) {
    body.points_mm.emplace_back(X_FO * p);
  }
  for (const Eigen::Vector3i& triangle : surface.triangles) {
    for (const int v : triangle) {
      lowest = std::min(lowest, body.points_mm[v].z());
      highest = std::max(highest, body.points_mm[v].z());
    }
  }
  X_FO.translation().z() = -lowest;
  for (Eigen::Vector3d& p : body.points_mm) p.z() -= lowest;
  body.height_mm = highest - lowest;

  body.triangles.reserve(surface.triangles.size());
  for (const Eigen::Vector3i& t : surface.triangles) {
    body.triangles.emplace_back(surface.weld[t[0]], surface.weld[t[1]], surface.weld[t[2]]);
  }
  body.corner_normals.reserve(surface.corner_normals.size());
  for (const auto& normals : surface.corner_normals) {
    const auto& R = X_FO.linear();
    body.corner_normals.push_back({R * normals[0], R * normals[1], R * normals[2]});
  }
  return body;
}

Pose centred_pose(const mesh::Surface& surface) {
  HP_CHECK(!surface.triangles.empty());
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const Eigen::Vector3i& triangle : surface.triangles) {
    for (const int v : triangle) {
      low = low.cwiseMin(surface.points[v]);
      high = high.cwiseMax(surface.points[v]);
    }
  }
  Pose X_FO = Pose::Identity();
  X_FO.translation().head<2>() = -0.5 * (low + high).head<2>();
  return X_FO;
}

bool film_can_follow(const Eigen::Vector3d& normal) {
  static const double limit = -std::cos(kThetaLost_rad);
  return normal.z() < limit;
}

Eigen::Vector2d pull(const Eigen::Vector3d& normal) {
  static const double limit = std::tan(0.5 * kThetaLimit_rad);
  const Eigen::Vector2d outward = normal.head<2>();
  const double sine = outward.norm();
  if (sine < 1e-12) return Eigen::Vector2d::Zero();  // flat: no horizontal direction to pull in
  const double tangent = std::min(sine / std::max(1.0 - normal.z(), 1e-300), limit);
  return -tangent / sine * outward;
}

}  // namespace hydroprint::waterline
