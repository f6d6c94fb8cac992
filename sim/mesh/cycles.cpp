#include "sim/mesh/cycles.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "sim/mesh/rays.h"
#include "sim/mesh/weld.h"

namespace hydroprint::mesh {
namespace {

/// Places that are examined on each patch.
constexpr std::size_t kPlaces = 2;
/// Distance of the examined points from the patch, relative to the model's diagonal.
constexpr double kBeside = 1e-5;

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
