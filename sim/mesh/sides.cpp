#include "sim/mesh/sides.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <utility>

#include "sim/mesh/rays.h"

namespace hydroprint::mesh {
namespace {

/// Lines that are drawn through a closed patch to find the patches around it.
constexpr std::size_t kLinesWithin = 8;
/// Lines are drawn through open patches in batches, until a majority is clear.
constexpr std::size_t kLinesPerBatch = 32;
constexpr std::size_t kBatches = 16;
/// Maximum number of batches for all patches together. If there are more patches, the smallest ones
/// remain undecided.
constexpr std::size_t kBatchesInAll = 64'000;
/// A majority is clear if it exceeds this number of standard deviations of a fair coin.
constexpr double kClear = 4;
/// An open patch is hidden if more than this share of its lines begin within a solid.
constexpr double kHidden = 0.9;

/// Votes of lines, of which only those with different front and back count.
struct Vote {
  double front = 0, back = 0;

  void add(bool front_has, bool back_has) {
    front += front_has && !back_has ? 1 : 0;
    back += back_has && !front_has ? 1 : 0;
  }
  [[nodiscard]] bool is_clear() const {
    return std::abs(front - back) > kClear * std::sqrt(front + back);
  }
};

/// What a ray from one side of a patch meets.
struct View {
  bool is_open = false;   ///< nothing
  bool is_even = false;   ///< an even number of faces
  bool in_solid = false;  ///< more faces of closed shells that it leaves than ones that it enters
};

class SideFinder {
 public:
  SideFinder(const std::vector<Eigen::Vector3d>& points,
             const std::vector<Eigen::Vector3i>& triangles, const Patches& found)
      : patches_(found.patches), sides_(patches_.size()) {
    if (!needs_rays()) return;
    patch_of_.resize(triangles.size());
    for (std::size_t i = 0; i < patches_.size(); ++i)
      for (const std::size_t t : patches_[i].triangles) patch_of_[t] = i;
    corners_.resize(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k)
        corners_[t][k] = points[static_cast<std::size_t>(triangles[t][static_cast<int>(k)])];
      if (found.flip[t]) std::swap(corners_[t][1], corners_[t][2]);
    }
    tree_ = std::make_unique<RayTree>(corners_);
  }

  Result<std::vector<Side>> run(const Context& context) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    HP_RETURN_IF_ERROR(judge_closed(context));
    HP_RETURN_IF_ERROR(judge_open(context));
    return std::move(sides_);
  }

 private:
  [[nodiscard]] static bool has_volume(const Patch& patch) {
    return patch.is_closed && !patch.is_flat;
  }

  /// Returns whether there may be cavities.
  [[nodiscard]] bool has_both_signs() const {
    bool has_positive = false, has_negative = false;
    for (const Patch& patch : patches_) {
      has_positive = has_positive || (has_volume(patch) && patch.volume_mm3 > 0);
      has_negative = has_negative || (has_volume(patch) && patch.volume_mm3 < 0);
    }
    return has_positive && has_negative;
  }

  [[nodiscard]] bool needs_rays() const {
    return has_both_signs() || !std::ranges::all_of(patches_, has_volume);
  }

  /// Returns the indices of the patches that satisfy a condition.
  template <class Condition>
  [[nodiscard]] std::vector<std::size_t> select(Condition condition) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < patches_.size(); ++i)
      if (condition(patches_[i])) out.push_back(i);
    return out;
  }

  /// Returns the closed patches around patch i, in ascending order: those around all points.
  [[nodiscard]] std::vector<std::size_t> patches_around(std::size_t i) const {
    std::vector<std::size_t> out;
    std::vector<RayHit> hits;
    bool is_first = true;
    for (const Line& line : LineSampler(corners_, patches_[i].triangles, i).draw(kLinesWithin)) {
      tree_->find_hits(line.point, line.direction, hits);
      std::vector<std::size_t> met;
      for (const RayHit& hit : hits)
        if (const std::size_t j = patch_of_[hit.triangle]; j != i && has_volume(patches_[j]))
          met.push_back(j);
      std::ranges::sort(met);
      std::vector<std::size_t> around;  // those that are met an odd number of times
      for (const std::size_t j : met) {
        if (!around.empty() && around.back() == j) {
          around.pop_back();
        } else {
          around.push_back(j);
        }
      }
      std::vector<std::size_t> both;
      std::ranges::set_intersection(out, around, std::back_inserter(both));
      out = is_first ? std::move(around) : std::move(both);
      is_first = false;
      if (out.empty()) break;
    }
    return out;
  }

  Status judge_closed(const Context& context) {
    std::vector<std::size_t> closed = select(has_volume);
    std::vector<std::vector<std::size_t>> around(patches_.size());
    if (has_both_signs()) {
      HP_RETURN_IF_ERROR(parallel_for(context, {}, closed.size(), [&](std::size_t k) {
        around[closed[k]] = patches_around(closed[k]);
        return Status{};
      }));
    }
    // A patch is larger than those within it, so they follow it.
    const auto size = [&](std::size_t i) { return std::abs(patches_[i].volume_mm3); };
    std::ranges::stable_sort(closed, std::greater{}, size);
    for (const std::size_t i : closed) judge_closed(i, around[i]);
    return {};
  }

  void judge_closed(std::size_t i, const std::vector<std::size_t>& around) {
    const auto size = [&](std::size_t j) { return std::abs(patches_[j].volume_mm3); };
    const double volume = patches_[i].volume_mm3;
    int winding = 0;
    std::size_t outermost = i;
    for (const std::size_t j : around) {
      if (size(j) <= size(i)) continue;
      winding += sides_[j].rule == SideRule::kCavity ? -1 : 1;
      if (size(j) > size(outermost)) outermost = j;
    }
    const bool is_opposed = (volume < 0) != (patches_[outermost].volume_mm3 < 0);
    const bool is_cavity = is_opposed && winding > 0;
    sides_[i] = {is_cavity ? SideRule::kCavity : SideRule::kVolume, (volume < 0) != is_cavity};
  }

  Status judge_open(const Context& context) {
    auto open = select([](const Patch& patch) { return !has_volume(patch); });
    for (const std::size_t i : open) sides_[i] = {SideRule::kUndecided, patches_[i].volume_mm3 < 0};
    std::ranges::stable_sort(open, std::greater{},
                             [&](std::size_t i) { return patches_[i].area_mm2; });
    if (open.size() > kBatchesInAll) open.resize(kBatchesInAll);
    return parallel_for(context, {}, open.size(), [&](std::size_t k) {
      const Side side = judge_open(open[k], std::min(kBatchesInAll / open.size(), kBatches));
      sides_[open[k]] = side;
      return Status{};
    });
  }

  [[nodiscard]] Side judge_open(std::size_t i, std::size_t batches) const {
    Vote open, even;
    std::size_t hidden = 0, drawn = 0;
    std::vector<RayHit> hits;
    LineSampler sampler(corners_, patches_[i].triangles, i);
    for (std::size_t batch = 0; batch < batches && !open.is_clear(); ++batch) {
      for (const Line& line : sampler.draw(kLinesPerBatch)) {
        const View front = look(line, line.direction, hits);
        const View back = look(line, -line.direction, hits);
        ++drawn;
        if (front.in_solid && back.in_solid) {
          ++hidden;
          continue;
        }
        open.add(front.is_open, back.is_open);
        even.add(front.is_even, back.is_even);
      }
    }
    const Vote& vote = open.is_clear() ? open : even;
    if (vote.is_clear()) return {SideRule::kRays, vote.back > vote.front};
    const bool is_hidden = static_cast<double>(hidden) > kHidden * static_cast<double>(drawn);
    return {is_hidden ? SideRule::kVolume : SideRule::kUndecided, patches_[i].volume_mm3 < 0};
  }

  [[nodiscard]] View look(const Line& line, const Eigen::Vector3d& direction,
                          std::vector<RayHit>& hits) const {
    tree_->find_hits(line.point, direction, hits);
    std::size_t count = 0;
    int winding = 0;
    for (const RayHit& hit : hits) {
      if (hit.triangle == line.triangle) continue;
      ++count;
      const std::size_t j = patch_of_[hit.triangle];
      if (has_volume(patches_[j])) winding += hit.from_behind != sides_[j].turn_over ? 1 : -1;
    }
    return {count == 0, count % 2 == 0, winding > 0};
  }

  const std::vector<Patch>& patches_;
  std::vector<Side> sides_;
  std::vector<std::size_t> patch_of_;  ///< for each triangle; empty without rays
  std::vector<Corners> corners_;       ///< for each triangle, flipped to agree with its patch
  std::unique_ptr<RayTree> tree_;
};

}  // namespace

Result<std::vector<Side>> outer_sides(const std::vector<Eigen::Vector3d>& points,
                                      const std::vector<Eigen::Vector3i>& triangles,
                                      const Patches& found, const Context& context) {
  return SideFinder(points, triangles, found).run(context);
}

}  // namespace hydroprint::mesh
