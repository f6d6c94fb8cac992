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

/// The film's velocity through a whole dip. The velocity per unit dip speed depends on the
/// immersion alone, so immersion takes the place of time.
struct DipField {
  film::Outline outline;                        ///< the film as it floats at rest
  double depth_mm = 0;                          ///< where the dip ends
  std::vector<double> immersion_mm;             ///< increasing
  std::vector<velocity::VelocityField> fields;  ///< one per immersion
};

/// The point of the film at rest that lands there (the inverse map of section 4.5): the film is
/// followed back from the landing to rest, from waterline to waterline, by a multistep rule of
/// third order that starts anew at events. Where and when it lands is known exactly, so no contact
/// has to be searched for; the velocity there is that of eq. (1), and near creases, where that
/// jumps, lies between those of the waterlines before and after.
/// @return nothing where no film arrives: inside the union of the object's parts, in a cavity
///         without film, behind a level top that the film cannot follow, beyond the film's edge,
///         or past the end of the dip
[[nodiscard]] std::optional<Eigen::Vector2d> trace_back(const DipField& dip,
                                                        const Landing& landing);

/// The same for many landings at once, in parallel; NaN where no film arrives.
[[nodiscard]] Result<std::vector<Eigen::Vector2d>> trace_back(const DipField& dip,
                                                              const std::vector<Landing>& landings,
                                                              std::string_view stage,
                                                              const Context& context);

/// Where the film at one waterline was when the film was at rest: a quadratic function on its film
/// mesh, in the same shape as a velocity.
struct RestMap {
  std::size_t waterline = 0;
  velocity::VelocityField rest_mm;
};

/// Where each node of the film mesh of waterline `k` was at rest.
/// @param known  of a waterline before: paths are followed no further than there; none: to rest
/// @return NaN where the film at `known` has no such point
[[nodiscard]] std::vector<Eigen::Vector2d> trace_back(const DipField& dip, std::size_t k,
                                                      const RestMap* known = nullptr);

}  // namespace hydroprint::flow
