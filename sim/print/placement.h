#pragma once

#include <optional>

#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/mesh/surface.h"
#include "sim/print/page.h"
#include "sim/print/settings.h"

namespace hydroprint::print {

/// A template to place under the gripper of a rig without a camera, and data about it.
struct Placement {
  Document document;             ///< the template, then a page with pictures of the orientation
  Pose X_FO = Pose::Identity();  ///< pose as used: lowest point on the water, z = 0
  /// Centre and extent of the first contact with the water: the box around the cross-section
  /// kFirstContact_mm above the lowest point, in F.
  Eigen::Vector2d contact_mm = Eigen::Vector2d::Zero(), contact_size_mm = Eigen::Vector2d::Zero();
  Warnings warnings;  ///< TEMPLATE_CUT_OFF: the paper is too small for parts of the template
};

/// Immersion for which the first contact is drawn.
inline constexpr double kFirstContact_mm = 0.5;

/// Draws the placement template, seen from above at exact scale: the film's edge, the axes of F
/// with a tick every 10 mm, the first contact in bold, and the object's silhouette in grey. A
/// ruler, the pose and a line of text are added if there is space. Returns the errors of check(),
/// kOutOfRange for paper smaller than the film in both orientations, and kFailedPrecondition if the
/// first contact misses the film.
[[nodiscard]] Result<Placement> placement(const mesh::Surface& surface,
                                          const std::optional<Pose>& X_FO,
                                          const film::Outline& outline,
                                          const PageSettings& settings, const Context& context);

}  // namespace hydroprint::print
