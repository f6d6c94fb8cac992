#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/landing.h"
#include "sim/flow/map_error.h"
#include "sim/flow/trace.h"
#include "sim/velocity/velocity.h"

// The steps of trace_back(), for this room only.
namespace hydroprint::flow {

/// A step may overshoot the waterline, and a landing may be as far from its neighbouring waterlines
/// as they are from each other. Such points still need a velocity. (The start of each path decides
/// whether its landing has film at all.)
inline constexpr double kFarReach_mm = velocity::Locator::kReach_mm;

/// A point of the film, traced back through the dip.
struct BackPath {
  Eigen::Vector2d point_mm;  ///< NaN: lost
  double immersion_mm;
  Eigen::Vector2d velocity;  ///< velocity of the film at that point and immersion
  std::size_t after;         ///< number of waterlines still before it
  Eigen::Vector2d later_velocity = Eigen::Vector2d::Zero();  ///< velocity one step later in the dip
  double later_span_mm = 0;
  bool keeps_on = false;  ///< where there is no film, keeps its velocity instead of being lost
  bool has_torn = false;  ///< the film is torn at a waterline that the path has passed

  [[nodiscard]] bool is_lost() const { return std::isnan(point_mm.x()); }
  void lose() { point_mm.setConstant(std::numeric_limits<double>::quiet_NaN()); }
};

/// Returns whether the multistep rule restarts at a step: it is so much longer than the previous
/// one that the shorter one crossed an event, where the velocity jumps.
[[nodiscard]] bool restarts(double span_mm, double previous_span_mm);

/// Returns the path that ends in a landing; it is lost if no film arrives.
[[nodiscard]] BackPath path_to(const DipField& dip, const Landing& landing);

/// Calls `trace` for parts of the landings that together are all of them, in parallel. Landings of
/// a part have similar immersions.
[[nodiscard]] Status for_each_part(const std::vector<Landing>& landings, std::string_view stage,
                                   const Context& context,
                                   const std::function<void(const Part&)>& trace);

/// Returns the paths that end in the landings of a part.
[[nodiscard]] std::vector<BackPath> paths_to(const DipField& dip,
                                             const std::vector<Landing>& landings,
                                             const Part& part);

/// Traces one step back to the waterline at `immersion_mm`; the path is lost where the field has no
/// film.
/// @param triangle  of the film mesh, near the point if possible; set to the one that contains the
///                  point
void step_back(const velocity::VelocityField& field, double immersion_mm, int& triangle,
               BackPath& path);

/// Returns an order in which consecutive paths begin near each other: up and down narrow strips.
[[nodiscard]] std::vector<std::size_t> neighbours_in_turn(const std::vector<BackPath>& paths);

/// Follows all paths back through the dip together, waterline by waterline, so that each film mesh
/// is read only once.
/// @param order  of neighbours_in_turn()
/// @param first  the waterline at which the paths end
void follow_back(const DipField& dip, const std::vector<std::size_t>& order, std::size_t first,
                 std::vector<BackPath>& paths);

/// Traces the last step of each path, to before first contact.
void come_to_rest(const DipField& dip, std::vector<BackPath>& paths);

}  // namespace hydroprint::flow
