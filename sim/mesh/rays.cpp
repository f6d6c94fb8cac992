#include "sim/mesh/rays.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/iterator/function_output_iterator.hpp>
#include <cmath>
#include <iterator>
#include <numbers>

namespace hydroprint::mesh {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 to_cgal(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct RayTree::Impl {
  Triangles triangles;
  Tree tree;
};

RayTree::RayTree(const std::vector<Corners>& triangles) : impl_(std::make_unique<Impl>()) {
  impl_->triangles.reserve(triangles.size());
  for (const Corners& c : triangles)
    impl_->triangles.emplace_back(to_cgal(c[0]), to_cgal(c[1]), to_cgal(c[2]));
  impl_->tree.insert(impl_->triangles.cbegin(), impl_->triangles.cend());
  impl_->tree.build();
}

RayTree::~RayTree() = default;

void RayTree::find_hits(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                        std::vector<RayHit>& out) const {
  out.clear();
  const Kernel::Vector_3 along(direction.x(), direction.y(), direction.z());
  const auto add = [&](const Triangles::const_iterator& hit) {
    const auto normal = CGAL::cross_product((*hit)[1] - (*hit)[0], (*hit)[2] - (*hit)[0]);
    out.push_back({static_cast<std::size_t>(std::distance(impl_->triangles.cbegin(), hit)),
                   normal * along > 0});
  };
  impl_->tree.all_intersected_primitives(Kernel::Ray_3(to_cgal(origin), along),
                                         boost::make_function_output_iterator(add));
}

LineSampler::LineSampler(const std::vector<Corners>& corners,
                         const std::vector<std::size_t>& members, std::uint64_t seed)
    : corners_(corners), members_(members), random_(seed) {
  double area = 0;
  area_until_.reserve(members.size());
  for (const std::size_t t : members) {
    const Corners& c = corners[t];
    area_until_.push_back(area += (c[1] - c[0]).cross(c[2] - c[0]).norm() / 2);
  }
}

double LineSampler::uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

Line LineSampler::through(std::size_t triangle) {
  const Corners& c = corners_[triangle];
  const Eigen::Vector3d a = c[1] - c[0], b = c[2] - c[0];
  const double root = std::sqrt(uniform()), share = uniform();
  const Eigen::Vector3d normal = a.cross(b).normalized(), along = a.normalized();
  const double radius = std::sqrt(uniform()), angle = 2 * std::numbers::pi * uniform();
  Line out;
  out.triangle = triangle;
  out.point = c[0] + root * ((1 - share) * a + share * b);
  out.direction = radius * (std::cos(angle) * along + std::sin(angle) * normal.cross(along)) +
                  std::sqrt(1 - radius * radius) * normal;
  return out;
}

std::vector<Line> LineSampler::draw(std::size_t count) {
  std::vector<Line> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = (static_cast<double>(i) + uniform()) / static_cast<double>(count);
    const auto found = std::ranges::upper_bound(area_until_, share * area_until_.back());
    const auto last = std::prev(area_until_.end());
    const auto member = std::distance(area_until_.begin(), std::min(found, last));
    out.push_back(through(members_[static_cast<std::size_t>(member)]));
  }
  return out;
}

}  // namespace hydroprint::mesh
