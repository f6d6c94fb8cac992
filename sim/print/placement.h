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

/// A page to lay under the gripper of a rig without a camera, and what it shows.
struct Placement {
  Document document;             ///< the template; then a page with pictures of the orientation
  Pose X_FO = Pose::Identity();  ///< as used: lowest point on the water, z = 0
  /// Middle of what the water meets first, and its extent: the box round the cross-section
  /// kFirstContact_mm above the lowest point, in F.
  Eigen::Vector2d contact_mm = Eigen::Vector2d::Zero(), contact_size_mm = Eigen::Vector2d::Zero();
  /// template_cut_off: parts of it that have no room on the paper; text_glyph_missing,
  /// text_shortened
  Warnings warnings;
};

/// How deep the object is in the water where its first contact is drawn.
inline constexpr double kFirstContact_mm = 0.5;

/// Draws the placement template, seen from above at exact scale: the film's edge, the axes of F
/// with a tick every 10 mm, in bold what touches the water first and in grey the object's
/// silhouette; a ruler, the pose and a line of text where there is room. Refuses (kOutOfRange) what
/// check refuses and paper that is smaller than the film, either way round; (kFailedPrecondition) a
/// first contact that misses the film. Fails as text::Font::standard() does.
[[nodiscard]] Result<Placement> placement(const mesh::Surface& surface,
                                          const std::optional<Pose>& X_FO,
                                          const film::Outline& outline,
                                          const PageSettings& settings, const Context& context);

}  // namespace hydroprint::print
