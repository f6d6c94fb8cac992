#include "sim/registration/shape.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hydroprint::registration {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
using Corners = std::array<Eigen::Vector3d, 3>;

constexpr std::size_t kSamplesForMoments = 4000;
constexpr double kClear_mm = 0.05;  ///< lines of sight end at this distance from the surface

Kernel::Point_3 to_cgal(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
Eigen::Vector3d to_eigen(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

Eigen::Vector3d barycentric(const Corners& c, const Eigen::Vector3d& p) {
  const Eigen::Vector3d a = c[1] - c[0], b = c[2] - c[0], d = p - c[0];
  const double aa = a.dot(a), ab = a.dot(b), bb = b.dot(b);
  const double det = aa * bb - ab * ab;
  if (!(det > 0)) return Eigen::Vector3d::Constant(1.0 / 3);
  const double v = (bb * d.dot(a) - ab * d.dot(b)) / det;
  const double w = (aa * d.dot(b) - ab * d.dot(a)) / det;
  return {1 - v - w, v, w};
}

Eigen::Vector3d blend(const Corners& values, const Eigen::Vector3d& weights) {
  return weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2];
}

double fraction(double x) { return x - std::floor(x); }

}  // namespace

struct Shape::Impl {
  explicit Impl(const mesh::Surface& surface) {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      Corners c;
      for (std::size_t k = 0; k < 3; ++k)
        c[k] = surface.points[static_cast<std::size_t>(surface.triangles[t][static_cast<int>(k)])];
      if (!((c[1] - c[0]).cross(c[2] - c[0]).norm() > 0)) continue;
      corners.push_back(c);
      normals.push_back(surface.corner_normals[t]);
      triangles.emplace_back(to_cgal(c[0]), to_cgal(c[1]), to_cgal(c[2]));
      for (const auto& p : c) box.extend(p);
    }
    tree.insert(triangles.cbegin(), triangles.cend());
    tree.build();
    tree.accelerate_distance_queries();
    take_moments();
  }

  [[nodiscard]] SurfacePoint point(std::size_t triangle, const Eigen::Vector3d& p) const {
    const Eigen::Vector3d weights = barycentric(corners[triangle], p);
    return {p, blend(normals[triangle], weights).normalized()};
  }

  [[nodiscard]] std::vector<SurfacePoint> samples(std::size_t count) const {
    std::vector<SurfacePoint> out;
    double total = 0;
    for (const auto& c : corners) total += area(c);
    const double each = total / static_cast<double>(count);
    double left = each / 2;  // area up to the next sample
    for (std::size_t t = 0; t < corners.size(); ++t) {
      for (left -= area(corners[t]); left <= 0; left += each) {
        // The sequence of the plastic number fills the unit square evenly, and thus the triangle.
        const auto i = static_cast<double>(out.size());
        const double r = std::sqrt(fraction(0.5 + 0.7548776662466927 * i));
        const double s = fraction(0.5 + 0.5698402909980532 * i);
        out.push_back(point(t, blend(corners[t], {1 - r, r * (1 - s), r * s})));
      }
    }
    return out;
  }

  [[nodiscard]] static double area(const Corners& c) {
    return (c[1] - c[0]).cross(c[2] - c[0]).norm() / 2;
  }

  void take_moments() {
    double total = 0;
    for (const auto& c : corners) {
      centroid += area(c) * (c[0] + c[1] + c[2]) / 3;
      total += area(c);
    }
    centroid /= total;
    const auto all = samples(kSamplesForMoments);
    double squares = 0;
    for (const auto& s : all) squares += (s.point_mm - centroid).squaredNorm();
    radius_mm = std::sqrt(squares / static_cast<double>(all.size()));
  }

  std::vector<Corners> corners, normals;
  Triangles triangles;
  Tree tree;
  Eigen::AlignedBox3d box;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  double radius_mm = 0;
};

Shape::Shape(const mesh::Surface& surface) : impl_(std::make_shared<const Impl>(surface)) {}

SurfacePoint Shape::closest(const Eigen::Vector3d& p_B) const {
  const auto [point, triangle] = impl_->tree.closest_point_and_primitive(to_cgal(p_B));
  const auto index = static_cast<std::size_t>(triangle - impl_->triangles.cbegin());
  return impl_->point(index, to_eigen(point));
}

std::optional<SurfacePoint> Shape::hit(const Eigen::Vector3d& from_B,
                                       const Eigen::Vector3d& towards_B) const try {
  const auto met =
      impl_->tree.first_intersection(Kernel::Ray_3(to_cgal(from_B), to_cgal(towards_B)));
  if (!met) return {};
  const auto* point = boost::get<Kernel::Point_3>(&met->first);
  if (point == nullptr) return {};  // the ray lies in a triangle's plane
  const auto index = static_cast<std::size_t>(met->second - impl_->triangles.cbegin());
  return impl_->point(index, to_eigen(*point));
} catch (const CGAL::Failure_exception&) {
  return {};  // the ray is nearly in a triangle's plane, or the triangle nearly degenerate
}

bool Shape::is_seen(const SurfacePoint& p_B, const Eigen::Vector3d& eye_B) const {
  const Eigen::Vector3d from = p_B.point_mm + kClear_mm * (eye_B - p_B.point_mm).normalized();
  if (p_B.normal.dot(eye_B - p_B.point_mm) <= 0) return false;
  return !impl_->tree.do_intersect(Kernel::Segment_3(to_cgal(from), to_cgal(eye_B)));
}

std::vector<SurfacePoint> Shape::samples(std::size_t count) const { return impl_->samples(count); }
double Shape::radius_mm() const { return impl_->radius_mm; }
const Eigen::Vector3d& Shape::centroid() const { return impl_->centroid; }
double Shape::diagonal_mm() const { return impl_->box.diagonal().norm(); }

mesh::Surface moved(mesh::Surface surface, const Pose& pose) {
  for (auto& p : surface.points) p = pose * p;
  for (auto& corners : surface.corner_normals)
    for (auto& n : corners) n = pose.linear() * n;
  return surface;
}

mesh::Surface mirrored(mesh::Surface surface) {
  for (auto& p : surface.points) p.x() = -p.x();
  for (auto& t : surface.triangles) std::swap(t[1], t[2]);
  for (auto& corners : surface.corner_normals) {
    for (auto& n : corners) n.x() = -n.x();
    std::swap(corners[1], corners[2]);
  }
  return surface;
}

mesh::Surface joined(mesh::Surface a, const mesh::Surface& b) {
  const auto offset = static_cast<int>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const auto& t : b.triangles) a.triangles.emplace_back(t.array() + offset);
  for (const int w : b.weld) a.weld.push_back(w + offset);
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(a.source_triangle, b.source_triangle);
  append(a.source_barycentric, b.source_barycentric);
  append(a.corner_normals, b.corner_normals);
  a.closed = a.closed && b.closed;
  return a;
}

}  // namespace hydroprint::registration
