#include "sim/mesh/orient.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "sim/base/check.h"
#include "sim/mesh/patches.h"
#include "sim/mesh/sides.h"

namespace hydroprint::mesh {
namespace {

std::size_t count_shells(std::size_t triangles, const Edges& edges) {
  Groups shells = shells_of(triangles, edges);
  std::size_t out = 0;
  for (std::size_t t = 0; t < triangles; ++t) out += shells.find(t) == t ? 1 : 0;
  return out;
}

/// Returns whether a patch encloses anything: open sheets do not if rays see the same from both
/// sides.
bool encloses(const Patch& patch, SideRule rule) {
  if (patch.is_closed) return !patch.is_flat;
  return rule == SideRule::kRays || !(patch.is_flat || patch.is_one_sided);
}

Orientation summarize(Patches found, const std::vector<Side>& sides) {
  Orientation out;
  out.flip = std::move(found.flip);
  out.inconsistent = found.inconsistent;
  out.one_sided = found.one_sided;
  std::vector<Shell> shells;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Patch& patch = found.patches[i];
    const auto [rule, turn_over] = sides[i];
    if (turn_over)
      for (const std::size_t t : patch.triangles) out.flip[t] = !out.flip[t];
    out.is_flat = out.is_flat && !encloses(patch, rule);
    out.inside_out += turn_over ? 1 : 0;
    out.cavities += rule == SideRule::kCavity ? 1 : 0;
    out.by_rays += rule == SideRule::kRays ? 1 : 0;
    out.undecided += rule == SideRule::kUndecided ? 1 : 0;
    shells.push_back({patch.triangles.size(), patch.area_mm2, patch.is_closed, rule, turn_over});
  }
  std::ranges::stable_sort(shells, std::greater{}, &Shell::area_mm2);
  if (shells.size() > kShellsListed) shells.resize(kShellsListed);
  out.largest = std::move(shells);
  return out;
}

}  // namespace

Result<Orientation> orient(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& weld,
                           const std::vector<Eigen::Vector3i>& triangles, const Edges& edges,
                           const Context& context) {
  HP_CHECK(weld.size() == points.size());
  HP_ASSIGN_OR_RETURN(Patches found,
                      unite_cycles(points, weld, triangles, edges,
                                   find_patches(points, weld, triangles, edges), context));
  HP_ASSIGN_OR_RETURN(const std::vector<Side> sides,
                      outer_sides(points, triangles, found, context));
  Orientation out = summarize(std::move(found), sides);
  out.shells = count_shells(triangles.size(), edges);
  return out;
}

}  // namespace hydroprint::mesh
