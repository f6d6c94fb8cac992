#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/flow/landing.h"
#include "sim/velocity/velocity.h"

namespace hydroprint::flow {

/// The film's velocity through a whole dip. The velocity per unit dip speed depends only on the
/// immersion, so immersion is used in place of time.
struct DipField {
  film::Outline outline;                        ///< the film as it floats at rest
  double depth_mm = 0;                          ///< immersion at the end of the dip
  std::vector<double> immersion_mm;             ///< increasing
  std::vector<velocity::VelocityField> fields;  ///< one per immersion
  /// For each field and each triangle of its film mesh, whether the film is torn there; empty
  /// without a sheet, whose velocity depends on the film's thickness, and where not yet known.
  std::vector<std::vector<char>> is_torn = {};
};

/// Traces a landing back to the point of the film at rest (the inverse map of section 4.5). Follows
/// the film from waterline to waterline with a third-order multistep rule, which restarts at
/// events. Place and time of the landing are known exactly, so there is no search for the contact.
/// The velocity there is that of eq. (1). Near creases, where eq. (1) jumps, it lies between the
/// velocities at the waterlines before and after.
/// @return nullopt where no film arrives: inside the union of the object's parts, in a cavity
///         without film, behind a level top that the film cannot follow, beyond the film's edge, or
///         past the end of the dip
[[nodiscard]] std::optional<Eigen::Vector2d> trace_back(const DipField& dip,
                                                        const Landing& landing);

/// Same as above for many landings, in parallel; NaN where no film arrives.
[[nodiscard]] Result<std::vector<Eigen::Vector2d>> trace_back(const DipField& dip,
                                                              const std::vector<Landing>& landings,
                                                              std::string_view stage,
                                                              const Context& context);

/// Maps the film at one waterline to its position at rest: a quadratic function on the film mesh,
/// stored like a velocity.
struct RestMap {
  std::size_t waterline = 0;
  velocity::VelocityField rest_mm;
};

/// Returns the position at rest of each node of the film mesh of waterline `k`.
/// @param known  map of an earlier waterline, at which tracing stops; nullptr: traces back to rest
///               A point beyond that film has the rest position of the film's nearest node: a gap
///               would grow by a ring of triangles from map to map, until no film is known
[[nodiscard]] std::vector<Eigen::Vector2d> trace_back(const DipField& dip, std::size_t k,
                                                      const RestMap* known = nullptr);

}  // namespace hydroprint::flow
