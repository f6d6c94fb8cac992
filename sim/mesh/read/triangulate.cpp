#include "sim/mesh/read/triangulate.h"

#include <Eigen/Geometry>
#include <cstddef>

#include "sim/base/check.h"

namespace hydroprint::mesh {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// Returns the polygon projected onto a plane in which it runs counter-clockwise.
std::vector<Eigen::Vector2d> flatten(const std::vector<Eigen::Vector3d>& points,
                                     std::span<const int> polygon) {
  const auto point = [&](std::size_t i) -> const Eigen::Vector3d& {
    return points[static_cast<std::size_t>(polygon[i % polygon.size()])];
  };
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // Newell's; its length is twice the area
  for (std::size_t i = 0; i < polygon.size(); ++i)
    normal += (point(i) - point(0)).cross(point(i + 1) - point(0));
  const Eigen::Vector3d x = normal.unitOrthogonal();
  const Eigen::Vector3d y = normal.cross(x).stableNormalized();
  std::vector<Eigen::Vector2d> flat;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d p = point(i) - point(0);
    flat.emplace_back(p.dot(x), p.dot(y));
  }
  return flat;
}

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a;
  const Eigen::Vector2d v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

bool fan_tiles(const std::vector<Eigen::Vector2d>& p) {
  for (std::size_t i = 2; i < p.size(); ++i)
    if (turn(p[0], p[i - 1], p[i]) < 0) return false;
  return true;
}

Triangles fan(std::size_t corners) {
  Triangles triangles;
  for (int i = 2; i < static_cast<int>(corners); ++i) triangles.push_back({0, i - 1, i});
  return triangles;
}

class EarClipper {
 public:
  explicit EarClipper(const std::vector<Eigen::Vector2d>& p) : p_(p) {
    for (int i = 0; i < static_cast<int>(p.size()); ++i) left_.push_back(i);
  }

  Triangles run() {
    std::size_t at = 0;
    while (left_.size() > 3) {
      std::size_t tried = 0;
      while (tried < left_.size() && !is_ear(at % left_.size())) ++at, ++tried;
      clip(at % left_.size());  // a self-intersecting polygon may have no ear: any corner will do
    }
    triangles_.push_back({left_[0], left_[1], left_[2]});
    return std::move(triangles_);
  }

 private:
  [[nodiscard]] int corner(std::size_t i) const { return left_[i % left_.size()]; }
  [[nodiscard]] const Eigen::Vector2d& point(int i) const {
    return p_[static_cast<std::size_t>(i)];
  }

  [[nodiscard]] bool is_ear(std::size_t i) const {
    const int before = corner(i + left_.size() - 1);
    const int here = corner(i);
    const int after = corner(i + 1);
    const auto& a = point(before);
    const auto& b = point(here);
    const auto& c = point(after);
    if (turn(a, b, c) <= 0) return false;
    for (const int j : left_) {
      if (j == before || j == here || j == after) continue;
      const auto& q = point(j);
      if (q == a || q == b || q == c) continue;
      if (turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0) return false;
    }
    return true;
  }

  void clip(std::size_t i) {
    triangles_.push_back({corner(i + left_.size() - 1), corner(i), corner(i + 1)});
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i));
  }

  const std::vector<Eigen::Vector2d>& p_;
  std::vector<int> left_;
  Triangles triangles_;
};

/// Maximum number of corners for ear clipping, which takes at least quadratic time.
constexpr std::size_t kMaxClipped = 4096;

}  // namespace

Triangles triangulate(const std::vector<Eigen::Vector3d>& points, std::span<const int> polygon) {
  HP_CHECK(polygon.size() >= 3);
  if (polygon.size() == 3) return {{0, 1, 2}};
  const auto flat = flatten(points, polygon);
  if (polygon.size() > kMaxClipped || fan_tiles(flat)) return fan(polygon.size());
  return EarClipper(flat).run();
}

}  // namespace hydroprint::mesh
