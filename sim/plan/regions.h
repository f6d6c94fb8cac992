#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/mesh/surface.h"
#include "sim/plan/fragments.h"

namespace hydroprint::plan {

struct RegionOptions {
  /// Connected pieces with a smaller area join a neighbouring piece.
  double min_piece_mm2 = 25;
};

/// A straight part of the line between the regions of two dips; frame O, mm.
struct SeamSegment {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
  int dip = 0;  ///< the two dips, dip < other_dip
  int other_dip = 0;
};

/// Size of one dip's region.
struct RegionSize {
  double area_mm2 = 0;
  int pieces = 0;
};

/// The decomposition of a surface into one region for each dip (section 6 of the paper).
struct Regions {
  int dips = 0;
  Fragments fragments;            ///< tile the surface
  std::vector<SeamSegment> seam;  ///< between regions of different dips
  double seam_mm = 0;             ///< total length of the seam
  std::vector<RegionSize> sizes;  ///< per dip; index k - 1 for dip k
  double unreached_share = 0;     ///< share of the outer surface that no dip reaches, in [0, 1]
};

/// Assigns each point of the surface to the dip with the least stretch among those that reach it.
/// Stretch is linear in each triangle, so regions meet inside triangles where two stretch fields
/// are equal. Small connected pieces then join a neighbour whose dip reaches all of them.
/// Connections are across edges of welded points, of which there may be one, two or more triangles
/// each. Errors: kInvalidArgument if there are not 1 to kMaxDips dips, a dip does not have one
/// value for each point, a value is negative or NaN, or the smallest area is negative or NaN;
/// kCancelled. Takes time linear in the number of triangles; the result does not depend on the
/// number of threads.
[[nodiscard]] Result<Regions> make_regions(const mesh::Surface& surface, const Stretch& stretch,
                                           const RegionOptions& options, const Context& context);

/// Returns the dip to which each point of the surface belongs, from 1; 0 where no dip reaches. A
/// point on a seam belongs to one of the dips there. Welded points belong to the same dip.
[[nodiscard]] std::vector<int> dips_at_points(const mesh::Surface& surface,
                                              const Fragments& fragments);

}  // namespace hydroprint::plan
