#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/waterline/body.h"
#include "sim/waterline/waterlines.h"

namespace hydroprint::waterline {

/// The area of the solid at one immersion.
struct SectionArea {
  double depth_mm = 0;  ///< immersion
  double area_mm2 = 0;
};
[[nodiscard]] std::vector<SectionArea> section_areas(const std::vector<Waterline>& lines);

/// Where the sections of a body do not agree with its volume.
struct SectionsOff {
  double sections_mm3 = 0;  ///< sum of the sections' areas
  double columns_mm3 = 0;   ///< the same sum, of the body's areas along vertical lines
  double immersion_mm = 0;  ///< of the section that is most wrong
  Eigen::Vector2d place_mm = Eigen::Vector2d::Zero();  ///< a place there where they differ, in F
  std::vector<int> triangles;  ///< some of the body's, nearest to this place first
};

/// Compares the areas of the sections, summed over the immersion, with the volume along
/// vertical lines through the body (Columns). Both are summed by the trapezoidal rule over
/// the waterlines, so that the distance of the waterlines does not count.
/// @return nullopt if they differ by at most 2 %, three standard errors of the vertical lines, and
///         what eight of these lines stand for
[[nodiscard]] std::optional<SectionsOff> check_sections(const Body& body,
                                                        const std::vector<Waterline>& lines,
                                                        const Motion& motion);

}  // namespace hydroprint::waterline
