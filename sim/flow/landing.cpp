#include "sim/flow/landing.h"

#include <limits>

#include "sim/waterline/waterlines.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
/// Corner normals with a smaller cosine between them make a crease.
constexpr double kCreaseCosine = 0.95;

}  // namespace

Landing shared(const Landing& a, const Landing& b) {
  return {a.point_mm, a.immersion_mm, 0.5 * (a.pull + b.pull), a.is_smooth && b.is_smooth,
          a.film_can_follow || b.film_can_follow};
}

Landings::Landings(const waterline::Body& body, const waterline::Motion& motion)
    : body_(body), motion_(motion) {
  Landing nowhere;
  nowhere.immersion_mm = std::numeric_limits<double>::infinity();
  points_.assign(body.points_mm.size(), nowhere);
  std::vector<int> corners(points_.size(), 0);
  std::vector<Vector3d> first_normal(points_.size());
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int v = body.triangles[t][i];
      const Vector3d& normal = body.corner_normals[t][i];
      const Landing here = at(body.points_mm[v], waterline::pull(normal));
      Landing& point = points_[v];
      if (corners[v]++ == 0) {
        point = here;
        point.is_smooth = true;
        first_normal[v] = normal;
      } else {
        point.pull += here.pull;
        point.is_smooth = point.is_smooth && first_normal[v].dot(normal) > kCreaseCosine;
      }
      point.film_can_follow = point.film_can_follow || waterline::film_can_follow(normal);
    }
  }
  for (std::size_t v = 0; v < points_.size(); ++v) {
    if (corners[v] > 0) points_[v].pull /= corners[v];
  }
}

Landing Landings::at(const Vector3d& point_mm, const Vector2d& pull) const {
  return {point_mm.head<2>() + waterline::offset_at(motion_, point_mm.z()), point_mm.z(),
          pull + waterline::drift_at(motion_, point_mm.z()), false, false};
}

Landing Landings::on(int triangle, const Vector3d& barycentric) const {
  const Eigen::Vector3i& v = body_.triangles[triangle];
  const auto& normals = body_.corner_normals[triangle];
  Vector3d point = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    point += barycentric[i] * body_.points_mm[v[i]];
    normal += barycentric[i] * normals[i];
  }
  normal.normalize();
  Landing landing = at(point, waterline::pull(normal));
  landing.is_smooth = points_[v[0]].is_smooth && points_[v[1]].is_smooth && points_[v[2]].is_smooth;
  landing.film_can_follow = waterline::film_can_follow(normal);
  return landing;
}

}  // namespace hydroprint::flow
