#include "sim/mesh/patches.h"

#include <cmath>
#include <utility>

namespace hydroprint::mesh {
namespace {

/// A volume below this share of area times diagonal counts as zero.
constexpr double kFlat = 1e-6;

class PatchFinder {
 public:
  PatchFinder(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& weld,
              const std::vector<Eigen::Vector3i>& triangles, const Edges& edges)
      : points_(points), weld_(weld), triangles_(triangles) {
    result_.flip.assign(triangles.size(), false);
    find_twins(edges);
  }

  Patches run() {
    std::vector<bool> seen(triangles_.size(), false);
    for (std::size_t first = 0; first < triangles_.size(); ++first) {
      if (seen[first]) continue;
      Patch patch = grow(first, seen);
      follow_majority(patch);
      measure(patch, points_, triangles_, result_.flip, boundary_middle(patch));
      result_.patches.push_back(std::move(patch));
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] const Eigen::Vector3d& point(int i) const {
    return points_[static_cast<std::size_t>(i)];
  }

  void find_twins(const Edges& edges) {
    twin_.assign(3 * triangles_.size(), -1);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto sides = edges.sides(e);
      if (sides.size() != 2) continue;
      twin_[static_cast<std::size_t>(sides[0])] = sides[1];
      twin_[static_cast<std::size_t>(sides[1])] = sides[0];
    }
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
          patch.is_closed = false;
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
    patch.is_one_sided = conflicts > 0;
    if (patch.is_one_sided) patch.is_closed = false;
    result_.one_sided += conflicts / 2;  // each such edge was visited from both sides
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

  const std::vector<Eigen::Vector3d>& points_;
  const std::vector<int>& weld_;
  const std::vector<Eigen::Vector3i>& triangles_;
  std::vector<int> twin_;
  Patches result_;
};

}  // namespace

void measure(Patch& patch, const std::vector<Eigen::Vector3d>& points,
             const std::vector<Eigen::Vector3i>& triangles, const std::vector<bool>& flip,
             const Eigen::Vector3d& origin) {
  Eigen::AlignedBox3d box;
  for (const auto t : patch.triangles) {
    const auto corner = [&](int k) -> Eigen::Vector3d {
      return points[static_cast<std::size_t>(triangles[t][k])] - origin;
    };
    const Eigen::Vector3d a = corner(0), b = corner(1), c = corner(2);
    patch.volume_mm3 += (flip[t] ? -1 : 1) * a.dot(b.cross(c)) / 6;
    patch.area_mm2 += (b - a).cross(c - a).norm() / 2;
    for (const auto& p : {a, b, c}) box.extend(p);
  }
  if (std::abs(patch.volume_mm3) > kFlat * patch.area_mm2 * box.diagonal().norm()) return;
  patch.is_flat = true;
  patch.volume_mm3 = 0;
}

Patches find_patches(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& weld,
                     const std::vector<Eigen::Vector3i>& triangles, const Edges& edges) {
  return PatchFinder(points, weld, triangles, edges).run();
}

}  // namespace hydroprint::mesh
