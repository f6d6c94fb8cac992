#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/waterline/body.h"
#include "sim/waterline/cross_section.h"
#include "sim/waterline/motion.h"
#include "sim/waterline/pull_index.h"
#include "sim/waterline/schedule.h"
#include "sim/waterline/traps.h"

namespace hydroprint::waterline {

/// The intersection of the water surface with the object at one immersion, in F, including the
/// object's horizontal offset.
struct Waterline {
  double immersion_mm = 0;
  CrossSection section;
  /// For each loop of the section, whether there is film on its open side. There is no film in
  /// holes that film never entered or whose air cannot escape, nor around loops within such holes.
  std::vector<char> bounds_film;
  PullIndex pulls;
};

/// The distance between two neighbouring waterlines.
struct Gap {
  double from_mm = 0, to_mm = 0;  ///< immersions
  [[nodiscard]] double width_mm() const { return to_mm - from_mm; }
  [[nodiscard]] double middle_mm() const { return 0.5 * (from_mm + to_mm); }
};

/// Where waterlines are further apart than wanted, because of ScheduleOptions::most.
struct Coarseness {
  double widening = 1;              ///< see Schedule
  std::vector<double> left_out_mm;  ///< see Schedule
  /// Gaps in which the topology changes at an immersion that was not located, widest first.
  std::vector<Gap> unresolved;
  [[nodiscard]] bool any() const {
    return widening > 1 || !left_out_mm.empty() || !unresolved.empty();
  }
};

/// All waterlines of one dip, by increasing immersion.
struct Waterlines {
  std::vector<Waterline> lines;
  double depth_mm = 0;           ///< immersion at which the dip ends
  bool stopped_at_edge = false;  ///< the dip ends because the waterline reached the film's edge
  std::vector<Trap> traps;       ///< enclosed film and air, largest first
  Coarseness coarse;
};

/// Returns the horizontal offset of the object at an immersion, mm: linear between the motion's
/// rows.
[[nodiscard]] Eigen::Vector2d offset_at(const Motion& motion, double immersion_mm);

/// Returns the derivative of offset_at() with respect to immersion, dimensionless. The object
/// carries the film at the waterline along at this rate.
[[nodiscard]] Eigen::Vector2d drift_at(const Motion& motion, double immersion_mm);

/// Computes the waterlines of a dip at the scheduled immersions, and more closely where contours
/// appear, vanish, split or merge (by bisection down to `event_gap_mm` * 5), but not more than
/// ScheduleOptions::most, plus one at the film's edge. Keeps track of which holes contain film; a
/// hole that opens inside the cross-section contains no film, and neither does one whose air cannot
/// escape (air.h).
/// @param outline  the floating film; the dip ends where the waterline reaches its edge
/// @return kFailedPrecondition if the first contact misses the film
[[nodiscard]] Result<Waterlines> take_waterlines(const Body& body, const film::Outline& outline,
                                                 double depth_mm, const Motion& motion,
                                                 const ScheduleOptions& options,
                                                 const Context& context);

/// Returns the closed curves that bound the film under the even-odd rule; the film's edge is the
/// first.
[[nodiscard]] std::vector<std::vector<Eigen::Vector2d>> film_curves(const film::Outline& outline,
                                                                    const Waterline& line);

}  // namespace hydroprint::waterline
