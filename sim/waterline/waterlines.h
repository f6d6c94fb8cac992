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

/// Where the water meets the object at one immersion, in F with the object's sideways offset.
struct Waterline {
  double immersion_mm = 0;
  CrossSection section;
  /// Per loop of the section: film lies on its open side. Outer loops of solids that float in a
  /// hole without film, and holes that film never entered, do not bound film.
  std::vector<char> bounds_film;
  PullIndex pulls;
};

/// All waterlines of one dip, by increasing immersion.
struct Waterlines {
  std::vector<Waterline> lines;
  double depth_mm = 0;           ///< immersion at which the dip ends
  bool stopped_at_edge = false;  ///< it ends there because the waterline reached the film's edge
  std::vector<Trap> traps;       ///< film and air closed in on the way, largest first
};

/// Sideways offset of the object at an immersion, mm: linear between the motion's rows.
[[nodiscard]] Eigen::Vector2d offset_at(const Motion& motion, double immersion_mm);

/// Its derivative by immersion, dimensionless: the part that the film at the waterline shares.
[[nodiscard]] Eigen::Vector2d drift_at(const Motion& motion, double immersion_mm);

/// Takes the waterlines of a dip: at the scheduled immersions, and more closely where contours
/// appear, vanish, split or merge (halving down to `event_gap_mm` * 5). Carries along which holes
/// hold film: only film can stay film, so a hole that opens inside the cross-section holds none.
/// @param outline  the film as it floats; the dip ends where the waterline reaches it
/// @return refuses with kFailedPrecondition if the first contact misses the film
[[nodiscard]] Result<Waterlines> take_waterlines(const Body& body, const film::Outline& outline,
                                                 double depth_mm, const Motion& motion,
                                                 const ScheduleOptions& options,
                                                 const Context& context);

/// The closed curves, film's edge first, that bound the film under the even-odd rule.
[[nodiscard]] std::vector<std::vector<Eigen::Vector2d>> film_curves(const film::Outline& outline,
                                                                    const Waterline& line);

}  // namespace hydroprint::waterline
