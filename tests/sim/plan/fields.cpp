#include "tests/sim/plan/fields.h"

#include <Eigen/Dense>
#include <limits>
#include <random>

#include "sim/plan/facets.h"

namespace hydroprint::testing {

plan::Stretch stretch_of(const mesh::Surface& surface,
                         const std::vector<std::function<double(const Eigen::Vector3d&)>>& dips) {
  plan::Stretch stretch;
  for (const auto& dip : dips) {
    auto& values = stretch.emplace_back();
    for (const int p : surface.weld) values.push_back(dip(surface.points[std::size_t(p)]));
  }
  return stretch;
}

plan::Stretch two_dips(const mesh::Surface& surface, const Eigen::Vector3d& normal) {
  return stretch_of(surface, {[=](const Eigen::Vector3d& p) { return 100 - normal.dot(p); },
                              [=](const Eigen::Vector3d& p) { return 100 + normal.dot(p); }});
}

mesh::Model rectangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& u,
                      const Eigen::Vector3d& v, int squares_u, int squares_v) {
  mesh::Model model;
  model.path = "rectangle";
  for (int j = 0; j <= squares_v; ++j)
    for (int i = 0; i <= squares_u; ++i)
      model.vertices.emplace_back(origin + u * i / squares_u + v * j / squares_v);
  for (int j = 0; j < squares_v; ++j)
    for (int i = 0; i < squares_u; ++i) {
      const int a = j * (squares_u + 1) + i;
      const int c = a + squares_u + 1;
      model.triangles.emplace_back(a, a + 1, c + 1);
      model.triangles.emplace_back(a, c + 1, c);
    }
  return model;
}

std::vector<SurfacePoint> random_points(const mesh::Surface& surface, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> triangle(0, static_cast<int>(surface.triangles.size()) - 1);
  std::uniform_real_distribution<double> fraction(0, 1);
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    SurfacePoint point;
    point.triangle = triangle(random);
    double a = fraction(random);
    double b = fraction(random);
    if (a + b > 1) {
      a = 1 - a;
      b = 1 - b;
    }
    point.barycentric = {1 - a - b, a, b};
    point.place = plan::place_of(surface, point.triangle, point.barycentric);
    points.push_back(point);
  }
  return points;
}

SurfacePoint nearest_point(const mesh::Surface& surface, const Eigen::Vector3d& place) {
  SurfacePoint nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i)
      corners.col(i) = surface.points[std::size_t(surface.triangles[t][i])];
    // Projects onto the plane, then into the triangle; exact for places on the surface.
    Eigen::Matrix<double, 3, 2> plane;
    plane << corners.col(1) - corners.col(0), corners.col(2) - corners.col(0);
    const Eigen::Vector2d ab = plane.colPivHouseholderQr().solve(place - corners.col(0));
    Eigen::Vector3d barycentric(1 - ab.sum(), ab[0], ab[1]);
    barycentric = barycentric.cwiseMax(0);
    barycentric /= barycentric.sum();
    const double distance = (corners * barycentric - place).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = {static_cast<int>(t), barycentric, corners * barycentric};
  }
  return nearest;
}

}  // namespace hydroprint::testing
