#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/film/outline.h"
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

/// A point of the surface at the moment the water reaches it.
struct Landing {
  Eigen::Vector2d point_mm = Eigen::Vector2d::Zero();  ///< where on the water, in F
  double immersion_mm = 0;
  Eigen::Vector2d pull = Eigen::Vector2d::Zero();  ///< film velocity per unit dip speed (eq. 1)
  bool film_can_follow = true;  ///< false: no film arrives, the surface recedes too fast
};

/// The point of the film at rest that lands there (the inverse map of section 4.5): the film is
/// followed back from the landing to rest by Heun's rule (second order), from waterline to
/// waterline. Where it lands is known exactly, so no contact has to be searched for.
/// @return nothing where no film arrives: inside the union of the object's parts, in a cavity
///         without film, behind a level top that the film cannot follow, beyond the film's edge,
///         or past the end of the dip
[[nodiscard]] std::optional<Eigen::Vector2d> trace_back(const DipField& dip,
                                                        const Landing& landing);

}  // namespace hydroprint::flow
