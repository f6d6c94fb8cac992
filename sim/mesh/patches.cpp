#include "sim/mesh/patches.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "sim/mesh/rays.h"
#include "sim/mesh/weld.h"

namespace hydroprint::mesh {
namespace {

/// A volume below this share of area times diagonal counts as zero.
constexpr double kFlat = 1e-6;

/// Places that are examined on each patch.
constexpr std::size_t kPlaces = 2;
/// Distance of the examined points from the patch, relative to the model's diagonal.
constexpr double kBeside = 1e-5;

/// Sets area, volume and flatness of a patch that has only triangles yet.
/// @param origin  tip of the cone that closes an open patch
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

/// Shells that the file orients without contradiction, of several patches.
class CycleFinder {
 public:
  CycleFinder(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& weld,
              const std::vector<Eigen::Vector3i>& triangles, const Edges& edges,
              const Patches& found)
      : points_(points), triangles_(triangles), found_(found) {
    find_candidates(edges, weld);
    if (candidates_.empty()) return;
    beside_mm_ = kBeside * diagonal(points_);
    corners_.reserve(triangles_.size());
    for (const Eigen::Vector3i& t : triangles_) {
      corners_.push_back({point(t[0]), point(t[1]), point(t[2])});
    }
    tree_ = std::make_unique<RayTree>(corners_);
  }

  /// Returns the patches of each cycle, in ascending order.
  Result<std::vector<std::vector<std::size_t>>> run(const Context& context) const {
    std::vector<char> is_cycle(candidates_.size(), 0);
    HP_RETURN_IF_ERROR(parallel_for(context, {}, candidates_.size(), [&](std::size_t i) {
      is_cycle[i] = winds_one_way(candidates_[i]) ? 1 : 0;
      return Status{};
    }));
    std::vector<std::vector<std::size_t>> out;
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      if (is_cycle[i] != 0) out.push_back(candidates_[i]);
    return out;
  }

 private:
  [[nodiscard]] const Eigen::Vector3d& point(int i) const {
    return points_[static_cast<std::size_t>(i)];
  }

  /// Finds shells of several patches with as many sides one way as the other at every edge.
  void find_candidates(const Edges& edges, const std::vector<int>& weld) {
    Groups shells = shells_of(triangles_.size(), edges);
    std::vector<char> fails(triangles_.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto sides = edges.sides(e);
      int sum = 0;
      for (const int side : sides) {
        const auto [from, to] = side_ends(side, triangles_, weld);
        sum += from < to ? 1 : -1;
      }
      if (sum != 0) fails[shells.find(static_cast<std::size_t>(sides[0] / 3))] = 1;
    }
    std::vector<std::vector<std::size_t>> patches_of(triangles_.size());
    for (std::size_t i = 0; i < found_.patches.size(); ++i)
      patches_of[shells.find(found_.patches[i].triangles[0])].push_back(i);
    for (std::size_t shell = 0; shell < patches_of.size(); ++shell) {
      shell_of_.push_back(shells.find(shell));
      if (patches_of[shell].size() > 1 && fails[shell] == 0)
        candidates_.push_back(std::move(patches_of[shell]));
    }
  }

  [[nodiscard]] bool winds_one_way(const std::vector<std::size_t>& patches) const {
    int lowest = 0, highest = 0;
    for (const std::size_t i : patches) {
      LineSampler sampler(corners_, found_.patches[i].triangles, i);
      for (const Line& line : sampler.draw(kPlaces)) {
        for (const double sign : {1.0, -1.0}) {
          const int around = winding(line, sign);
          lowest = std::min(lowest, around);
          highest = std::max(highest, around);
        }
      }
      if (lowest < 0 && highest > 0) return false;
    }
    return lowest < 0 || highest > 0;  // neither: a surface with an opposed copy
  }

  /// Returns how often the shell winds around a point beside a place of it.
  [[nodiscard]] int winding(const Line& line, double sign) const {
    const Corners& c = corners_[line.triangle];
    const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    std::vector<RayHit> hits;
    tree_->find_hits(line.point + sign * beside_mm_ * normal, sign * line.direction, hits);
    int sum = 0;
    for (const RayHit& hit : hits) {
      if (shell_of_[hit.triangle] == shell_of_[line.triangle]) sum += hit.from_behind ? 1 : -1;
    }
    return sum;
  }

  const std::vector<Eigen::Vector3d>& points_;
  const std::vector<Eigen::Vector3i>& triangles_;
  const Patches& found_;
  std::vector<std::vector<std::size_t>> candidates_;
  std::vector<std::size_t> shell_of_;  ///< for each triangle
  double beside_mm_ = 0;
  std::vector<Corners> corners_;
  std::unique_ptr<RayTree> tree_;
};

Patch united(const std::vector<std::size_t>& parts, const std::vector<Patch>& patches) {
  Patch out;
  for (const std::size_t i : parts)
    out.triangles.insert(out.triangles.end(), patches[i].triangles.begin(),
                         patches[i].triangles.end());
  return out;
}

}  // namespace

Patches find_patches(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& weld,
                     const std::vector<Eigen::Vector3i>& triangles, const Edges& edges) {
  return PatchFinder(points, weld, triangles, edges).run();
}

Result<Patches> unite_cycles(const std::vector<Eigen::Vector3d>& points,
                             const std::vector<int>& weld,
                             const std::vector<Eigen::Vector3i>& triangles, const Edges& edges,
                             Patches found, const Context& context) {
  HP_ASSIGN_OR_RETURN(const auto cycles,
                      CycleFinder(points, weld, triangles, edges, found).run(context));
  for (const std::vector<std::size_t>& cycle : cycles) {
    Patch patch = united(cycle, found.patches);
    measure(patch, points, triangles, found.flip,
            points[static_cast<std::size_t>(triangles[patch.triangles[0]][0])]);
    for (const std::size_t i : cycle) found.patches[i].triangles.clear();
    found.patches[cycle[0]] = std::move(patch);
  }
  std::erase_if(found.patches, [](const Patch& patch) { return patch.triangles.empty(); });
  return found;
}

}  // namespace hydroprint::mesh
