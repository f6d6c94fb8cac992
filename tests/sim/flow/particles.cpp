#include "tests/sim/flow/particles.h"

#include <Eigen/LU>
#include <algorithm>

namespace hydroprint::flow::reference {

using Eigen::Vector2d;
using Eigen::Vector3d;

Particles::Particles(const waterline::Body& body, const DipField& dip, double step_mm)
    : body_(body), dip_(dip), step_mm_(step_mm) {
  layers_.resize(static_cast<std::size_t>(body.height_mm) + 2);
  for (int t = 0; t < static_cast<int>(body.triangles.size()); ++t) {
    const Eigen::Vector3i& v = body.triangles[t];
    const auto [low, high] =
        std::minmax({body.points_mm[v[0]].z(), body.points_mm[v[1]].z(), body.points_mm[v[2]].z()});
    for (int layer = static_cast<int>(low); layer <= static_cast<int>(high); ++layer) {
      layers_[layer].push_back(t);
    }
  }
}

Vector2d Particles::velocity(const Vector2d& point_mm, double depth_mm) const {
  const auto& depths = dip_.immersion_mm;
  const auto next = std::upper_bound(depths.begin(), depths.end(), depth_mm) - depths.begin();
  const auto field = [&](std::ptrdiff_t k) {
    Vector2d u = Vector2d::Zero();
    (void)dip_.fields[k].at(point_mm, velocity::Locator::kReach_mm, u);
    return u;
  };
  if (next == 0) return depth_mm / depths[0] * field(0);
  if (next == static_cast<std::ptrdiff_t>(depths.size())) return field(next - 1);
  const double share = (depth_mm - depths[next - 1]) / (depths[next] - depths[next - 1]);
  return (1 - share) * field(next - 1) + share * field(next);
}

std::optional<Particles::Contact> Particles::contact(const Vector3d& from,
                                                     const Vector3d& to) const {
  double first = 2;
  Contact contact;
  for (const int t : layers_[static_cast<std::size_t>(std::max(0.0, from.z()))]) {
    const Vector3d& a = body_.points_mm[body_.triangles[t][0]];
    if ((a - from).head<2>().cwiseAbs().maxCoeff() > 5) continue;  // faces are at most 2 mm long
    Eigen::Matrix3d system;
    system << body_.points_mm[body_.triangles[t][1]] - a,
        body_.points_mm[body_.triangles[t][2]] - a, from - to;
    if (std::abs(system.determinant()) < 1e-14) continue;
    const Vector3d x = system.inverse() * (from - a);
    constexpr double kSlack = 1e-7;
    if (x[0] < -kSlack || x[1] < -kSlack || x[0] + x[1] > 1 + kSlack || x[2] < -kSlack ||
        x[2] > 1 + kSlack || x[2] >= first) {
      continue;
    }
    first = x[2];
    contact = {t, {1 - x[0] - x[1], x[0], x[1]}};
  }
  if (first > 1.5) return std::nullopt;
  return contact;
}

std::optional<Particles::Contact> Particles::follow(Vector2d p) const {
  std::size_t next = 0;  // number of the next waterline
  for (double depth = 0; depth < dip_.depth_mm;) {
    // A step stays within one layer of 1 mm height, so that only the faces of this layer can be
    // touched. It also ends at waterlines: the velocity has a kink there, or nearly a jump if two
    // waterlines enclose an edge.
    double end = std::min({depth + step_mm_, std::floor(depth) + 1, dip_.depth_mm});
    while (next < dip_.immersion_mm.size() && dip_.immersion_mm[next] <= depth) ++next;
    if (next < dip_.immersion_mm.size()) end = std::min(end, dip_.immersion_mm[next]);
    const double h = end - depth;
    const Vector2d k1 = velocity(p, depth);
    const Vector2d k2 = velocity(p + 0.5 * h * k1, depth + 0.5 * h);
    const Vector2d k3 = velocity(p + 0.5 * h * k2, depth + 0.5 * h);
    const Vector2d k4 = velocity(p + h * k3, depth + h);
    const Vector2d to = p + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (auto found = contact({p.x(), p.y(), depth}, {to.x(), to.y(), end})) return found;
    p = to;
    depth = end;
  }
  return std::nullopt;
}

}  // namespace hydroprint::flow::reference
