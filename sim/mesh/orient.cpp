#include "sim/mesh/orient.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sim/base/check.h"
#include "sim/mesh/groups.h"

namespace hydroprint::mesh {
namespace {

/// Triangles connected across edges of exactly two faces.
struct Patch {
  std::vector<std::size_t> triangles;
  double volume = 0;
  bool closed = true;
  bool flat = false;    ///< negligible volume
  bool turned = false;  ///< flipped as a whole
  Eigen::AlignedBox3d box;
};

/// Maximum number of triangles that are examined (in about a second) to distinguish cavities from
/// inverted parts. Beyond it, a part within the bounding box of another counts as a cavity.
constexpr std::size_t kMaxWindingTriangles = 100'000'000;

class Orienter {
 public:
  Orienter(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& weld,
           const std::vector<Eigen::Vector3i>& triangles, const Edges& edges)
      : points_(points), weld_(weld), triangles_(triangles), edges_(edges) {
    result_.flip.assign(triangles.size(), false);
  }

  Orientation run() {
    count_shells();
    find_neighbours();
    collect_patches();
    double total = 0;
    for (auto& patch : patches_) {
      measure(patch);
      total += patch.volume;
    }
    // If the whole model is inverted, not just some parts, its cavities have a positive volume.
    if (total < 0)
      for (auto& patch : patches_) turn_over(patch);
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      if (patches_[i].flat || patches_[i].volume >= 0) continue;
      if (patches_[i].closed && is_inside_another(i)) {
        ++result_.cavities;
      } else {
        turn_over(patches_[i]);
      }
    }
    for (const auto& patch : patches_) result_.inside_out += patch.turned ? 1 : 0;
    result_.is_flat = std::ranges::all_of(patches_, &Patch::flat);
    return std::move(result_);
  }

 private:
  [[nodiscard]] const Eigen::Vector3d& point(int i) const {
    return points_[static_cast<std::size_t>(i)];
  }

  void count_shells() {
    Groups groups(triangles_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e)
      for (const int side : edges_.sides(e))
        groups.join(static_cast<std::size_t>(edges_.sides(e)[0] / 3),
                    static_cast<std::size_t>(side / 3));
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (groups.find(t) == t) ++result_.shells;
  }

  void find_neighbours() {
    twin_.assign(3 * triangles_.size(), -1);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto sides = edges_.sides(e);
      if (sides.size() != 2) continue;
      twin_[static_cast<std::size_t>(sides[0])] = sides[1];
      twin_[static_cast<std::size_t>(sides[1])] = sides[0];
    }
  }

  void collect_patches() {
    std::vector<bool> seen(triangles_.size(), false);
    for (std::size_t first = 0; first < triangles_.size(); ++first)
      if (!seen[first]) patches_.push_back(grow(first, seen));
  }

  Patch grow(std::size_t first, std::vector<bool>& seen) {
    Patch patch;
    auto& members = patch.triangles;
    members.push_back(first);
    seen[first] = true;
    std::size_t conflicts = 0;
    for (std::size_t next = 0; next < members.size(); ++next) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto side = static_cast<int>(3 * members[next] + k);
        const int twin = twin_[static_cast<std::size_t>(side)];
        if (twin < 0) {
          patch.closed = false;
          continue;
        }
        const bool agrees =
            side_ends(side, triangles_, weld_).from != side_ends(twin, triangles_, weld_).from;
        const auto other = static_cast<std::size_t>(twin / 3);
        const bool flip = result_.flip[members[next]] != !agrees;
        if (!seen[other]) {
          seen[other] = true;
          result_.flip[other] = flip;
          members.push_back(other);
        } else if (result_.flip[other] != flip) {
          ++conflicts;
        }
      }
    }
    result_.one_sided += conflicts / 2;  // each such edge was visited from both sides
    follow_majority(patch);
    return patch;
  }

  void follow_majority(const Patch& patch) {
    std::size_t flipped = 0;
    for (const auto t : patch.triangles) flipped += result_.flip[t] ? 1 : 0;
    if (2 * flipped > patch.triangles.size()) {
      for (const auto t : patch.triangles) result_.flip[t] = !result_.flip[t];
      flipped = patch.triangles.size() - flipped;
    }
    result_.inconsistent += flipped;
  }

  [[nodiscard]] Eigen::Vector3d boundary_middle(const Patch& patch) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    for (const auto t : patch.triangles) {
      for (int k = 0; k < 3; ++k) {
        if (twin_[3 * t + static_cast<std::size_t>(k)] >= 0) continue;
        sum += point(triangles_[t][k]) + point(triangles_[t][(k + 1) % 3]);
        count += 2;
      }
    }
    return count > 0 ? Eigen::Vector3d(sum / count) : point(triangles_[patch.triangles[0]][0]);
  }

  void measure(Patch& patch) {
    const Eigen::Vector3d origin = boundary_middle(patch);
    double area = 0;
    for (const auto t : patch.triangles) {
      const Eigen::Vector3d a = point(triangles_[t][0]) - origin;
      const Eigen::Vector3d b = point(triangles_[t][1]) - origin;
      const Eigen::Vector3d c = point(triangles_[t][2]) - origin;
      patch.volume += (result_.flip[t] ? -1 : 1) * a.dot(b.cross(c)) / 6;
      area += (b - a).cross(c - a).norm() / 2;
      for (int k = 0; k < 3; ++k) patch.box.extend(point(triangles_[t][k]));
    }
    if (std::abs(patch.volume) <= 1e-6 * area * patch.box.diagonal().norm()) {
      patch.flat = true;
      patch.volume = 0;
    }
  }

  void turn_over(Patch& patch) {
    if (patch.flat) return;
    for (const auto t : patch.triangles) result_.flip[t] = !result_.flip[t];
    patch.volume = -patch.volume;
    patch.turned = !patch.turned;
  }

  /// Returns the signed solid angle of triangle t seen from q, divided by 4 pi (van Oosterom and
  /// Strackee 1983).
  [[nodiscard]] double winding(std::size_t t, const Eigen::Vector3d& q) const {
    const Eigen::Vector3d a = point(triangles_[t][0]) - q;
    const Eigen::Vector3d b = point(triangles_[t][1]) - q;
    const Eigen::Vector3d c = point(triangles_[t][2]) - q;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    const double angle = 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc +
                                                               b.dot(c) * la + c.dot(a) * lb);
    return (result_.flip[t] ? -1 : 1) * angle / (4 * std::numbers::pi);
  }

  bool is_inside_another(std::size_t i) {
    const Eigen::Vector3d q = point(triangles_[patches_[i].triangles[0]][0]);
    for (std::size_t j = 0; j < patches_.size(); ++j) {
      const auto& other = patches_[j];
      if (j == i || !other.closed || other.volume <= 0 || !other.box.contains(patches_[i].box))
        continue;
      tested_ += other.triangles.size();
      if (tested_ > kMaxWindingTriangles) return true;
      double sum = 0;
      for (const auto t : other.triangles) sum += winding(t, q);
      if (sum > 0.5) return true;
    }
    return false;
  }

  const std::vector<Eigen::Vector3d>& points_;
  const std::vector<int>& weld_;
  const std::vector<Eigen::Vector3i>& triangles_;
  const Edges& edges_;
  std::vector<int> twin_;
  std::vector<Patch> patches_;
  std::size_t tested_ = 0;
  Orientation result_;
};

}  // namespace

Orientation orient(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& weld,
                   const std::vector<Eigen::Vector3i>& triangles, const Edges& edges) {
  HP_CHECK(weld.size() == points.size());
  return Orienter(points, weld, triangles, edges).run();
}

}  // namespace hydroprint::mesh
