#include "sim/plan/fragments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hydroprint::plan {
namespace {

constexpr std::size_t kBlock = 2048;           // triangles per task
constexpr double kLeastShare = 1e-12;          // smaller parts of a triangle are rounding errors
using Polygon = std::vector<Eigen::Vector3d>;  // barycentric

/// Twice the signed area of a polygon's corners 0, a and b in units of the triangle's area.
double fan_share(const Eigen::Vector3d& o, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a[1] - o[1]) * (b[2] - o[2]) - (a[2] - o[2]) * (b[1] - o[1]);
}

double share_of(std::span<const Eigen::Vector3d> polygon) {
  double share = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    share += fan_share(polygon[0], polygon[i - 1], polygon[i]);
  return share;
}

/// Keeps the part of a polygon where the linear function with these values at the triangle's
/// corners is not negative.
void clip_polygon(const Eigen::Vector3d& at_corners, Polygon& polygon, Polygon& buffer) {
  buffer.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    const double at_a = at_corners.dot(a);
    const double at_b = at_corners.dot(b);
    if (at_a >= 0) buffer.push_back(a);
    if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) {
      const double fraction = at_a / (at_a - at_b);
      buffer.emplace_back((1 - fraction) * a + fraction * b);
    }
  }
  polygon.swap(buffer);
}

/// Divides single triangles; keeps buffers between them.
class TriangleDivision {
 public:
  TriangleDivision(const mesh::Surface& surface, const Stretch& stretch)
      : surface_(surface), stretch_(stretch) {}

  void divide(std::size_t triangle, Fragments& fragments) {
    read_corners(triangle);
    const std::size_t before = fragments.all.size();
    for (int k = 0; k < dips(); ++k) {
      polygon_ = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      if (cut_out(k)) append(triangle, k + 1, fragments);
    }
    if (fragments.all.size() == before) {
      polygon_ = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      append(triangle, least_at_centre(), fragments);
    }
    fragments.reach.push_back(reach());
  }

 private:
  [[nodiscard]] int dips() const { return static_cast<int>(stretch_.size()); }

  void read_corners(std::size_t triangle) {
    const auto& t = surface_.triangles[triangle];
    for (std::size_t k = 0; k < stretch_.size(); ++k)
      for (int i = 0; i < 3; ++i) {
        const int point = surface_.weld[static_cast<std::size_t>(t[i])];
        corners_[k][i] = stretch_[k][static_cast<std::size_t>(point)];
      }
  }

  [[nodiscard]] const Eigen::Vector3d& corners(int k) const {
    return corners_[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] bool is_reached(int k) const { return corners(k).allFinite(); }

  /// Leaves in polygon_ the part where dip k has the least stretch; false if it is empty.
  bool cut_out(int k) {
    if (!is_reached(k)) return false;
    for (int j = 0; j < dips(); ++j) {
      if (j == k || !is_reached(j)) continue;
      if (corners(j) == corners(k)) {
        if (j < k) return false;
        continue;
      }
      clip_polygon(corners(j) - corners(k), polygon_, buffer_);
      if (polygon_.size() < 3) return false;
    }
    return share_of(polygon_) > kLeastShare;
  }

  void append(std::size_t triangle, int dip, Fragments& fragments) const {
    fragments.all.push_back(
        {static_cast<int>(triangle), dip, fragments.corners.size(), polygon_.size()});
    fragments.corners.insert(fragments.corners.end(), polygon_.begin(), polygon_.end());
  }

  [[nodiscard]] int least_at_centre() const {
    int dip = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < dips(); ++k) {
      if (!is_reached(k) || corners(k).sum() >= least) continue;
      least = corners(k).sum();
      dip = k + 1;
    }
    return dip;
  }

  [[nodiscard]] std::uint16_t reach() const {
    unsigned bits = 0;
    for (int k = 0; k < dips(); ++k) bits |= is_reached(k) ? 1U << k : 0U;
    return static_cast<std::uint16_t>(bits);
  }

  const mesh::Surface& surface_;
  const Stretch& stretch_;
  std::array<Eigen::Vector3d, kMaxDips> corners_;
  Polygon polygon_, buffer_;
};

void append_block(const Fragments& block, Fragments& whole) {
  const std::size_t shift = whole.corners.size();
  for (Fragment fragment : block.all) {
    fragment.first_corner += shift;
    whole.all.push_back(fragment);
  }
  whole.corners.insert(whole.corners.end(), block.corners.begin(), block.corners.end());
  whole.reach.insert(whole.reach.end(), block.reach.begin(), block.reach.end());
}

void index_triangles(std::size_t triangles, Fragments& fragments) {
  fragments.begin.assign(triangles + 1, 0);
  for (const auto& f : fragments.all) ++fragments.begin[static_cast<std::size_t>(f.triangle) + 1];
  for (std::size_t t = 0; t < triangles; ++t) fragments.begin[t + 1] += fragments.begin[t];
}

}  // namespace

double depth_inside(std::span<const Eigen::Vector3d> polygon, const Eigen::Vector3d& barycentric) {
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto& a = polygon[i];
    const auto& b = polygon[(i + 1) % polygon.size()];
    const double length = std::hypot(b[1] - a[1], b[2] - a[2]);
    if (length > 0) depth = std::min(depth, fan_share(a, b, barycentric) / length);
  }
  return depth;
}

std::size_t Fragments::find(int triangle, const Eigen::Vector3d& barycentric) const {
  const auto t = static_cast<std::size_t>(triangle);
  std::size_t deepest = begin[t];
  if (begin[t + 1] - begin[t] == 1) return deepest;
  double depth = -std::numeric_limits<double>::infinity();
  for (std::size_t f = begin[t]; f < begin[t + 1]; ++f) {
    const double inside = depth_inside(polygon(f), barycentric);
    if (inside <= depth) continue;
    depth = inside;
    deepest = f;
  }
  return deepest;
}

double Fragments::share(std::size_t fragment) const { return share_of(polygon(fragment)); }

Result<Fragments> divide_triangles(const mesh::Surface& surface, const Stretch& stretch,
                                   const Context& context) {
  const std::size_t triangles = surface.triangles.size();
  std::vector<Fragments> blocks((triangles + kBlock - 1) / kBlock);
  HP_RETURN_IF_ERROR(parallel_for(context, "regions", blocks.size(), [&](std::size_t b) -> Status {
    TriangleDivision division(surface, stretch);
    const std::size_t end = std::min((b + 1) * kBlock, triangles);
    for (std::size_t t = b * kBlock; t < end; ++t) division.divide(t, blocks[b]);
    return {};
  }));
  Fragments fragments;
  for (const auto& block : blocks) append_block(block, fragments);
  index_triangles(triangles, fragments);
  return fragments;
}

std::vector<int> reached_corners(const mesh::Surface& surface, const Fragments& fragments) {
  std::vector<int> at_weld(surface.points.size(), -1);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (fragments.reach[t] == 0) continue;
    for (int c = 0; c < 3; ++c) {
      const auto p = static_cast<std::size_t>(surface.triangles[t][c]);
      int& corner = at_weld[static_cast<std::size_t>(surface.weld[p])];
      if (corner < 0) corner = 3 * static_cast<int>(t) + c;
    }
  }
  std::vector<int> out;
  for (const int weld : surface.weld) out.push_back(at_weld[static_cast<std::size_t>(weld)]);
  return out;
}

}  // namespace hydroprint::plan
