#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

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
/// followed back from the landing to rest by Heun's rule (second order), from waterline to
/// waterline. Where and when it lands is known exactly, so no contact has to be searched for; the
/// velocity there is that of eq. (1), and near creases, where that jumps, lies between those of the
/// waterlines before and after.
/// @return nothing where no film arrives: inside the union of the object's parts, in a cavity
///         without film, behind a level top that the film cannot follow, beyond the film's edge,
///         or past the end of the dip
[[nodiscard]] std::optional<Eigen::Vector2d> trace_back(const DipField& dip,
                                                        const Landing& landing);

}  // namespace hydroprint::flow
