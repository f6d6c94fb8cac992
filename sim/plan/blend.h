#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/mesh/surface.h"
#include "sim/plan/distance.h"
#include "sim/plan/regions.h"

namespace hydroprint::plan {

/// Default width over which a dip's colour fades beyond its region; the paper's H.
inline constexpr double kBlend_mm = 5;

/// How much of the colour of each point each dip prints (eq. 7 of the paper, normalised).
/// w_k = t_k / (t_1 + ... + t_K) with t_k = f(d_k) min(1, e_k / H), where f = 1 in the region of
/// dip k and max(0, 1 - d_k / H) elsewhere. d_k is the geodesic distance from the region. e_k is
/// the geodesic distance, within the part of the surface that dip k reaches, from those edges of
/// that part beyond which another dip reaches. t_k = 0 where dip k does not reach. If all t_k are
/// 0, the dip of the region has weight 1.
class BlendWeights {
 public:
  /// @param regions   of this surface
  /// @param blend_mm  H > 0
  /// Errors: kInvalidArgument if blend_mm is not positive and finite; kCancelled;
  /// kResourceExhausted if it is too large for the surface. The result does not depend on the
  /// number of threads.
  [[nodiscard]] static Result<BlendWeights> create(const mesh::Surface& surface,
                                                   const Regions& regions, double blend_mm,
                                                   const Context& context);

  [[nodiscard]] int dips() const { return static_cast<int>(distance_.size()); }

  /// Returns the weight of each dip (index k - 1 for dip k) at a point of a triangle. Their sum is
  /// 1, or 0 if no dip reaches the triangle. May be called from several threads.
  [[nodiscard]] std::vector<double> at(int triangle, const Eigen::Vector3d& barycentric) const;

  /// Returns the weight of one dip, as at() does. Faster where one dip prints the whole triangle.
  [[nodiscard]] double of_dip(int dip, int triangle, const Eigen::Vector3d& barycentric) const;

  /// Returns the weights at the points of the surface: index k - 1 for dip k, then one value for
  /// each point. Triangles at a point may be reached by different dips; the first one that any dip
  /// reaches counts. 0 at points without such a triangle. Welded points have the same weights.
  /// @param surface  as in create()
  [[nodiscard]] Result<std::vector<std::vector<double>>> at_points(const mesh::Surface& surface,
                                                                   const Context& context) const;

 private:
  [[nodiscard]] int find_only_dip(int triangle) const;

  double blend_mm_ = kBlend_mm;
  Fragments fragments_;
  std::vector<DistanceField> distance_;  ///< per dip: from its region
  std::vector<DistanceField> reach_;     ///< per dip: from the end of its reach
  std::vector<int> only_dip_;            ///< per triangle: see find_only_dip()
};

}  // namespace hydroprint::plan
