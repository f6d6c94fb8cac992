#pragma once

#include <vector>

#include "sim/registration/film_frame/markers.h"

namespace hydroprint::registration {

/// An assignment of found markers to markers of the layout.
struct Matching {
  std::vector<int> found;  ///< for each marker of the layout, the found marker's index; -1: none
  Pose X_CF = Pose::Identity();
  double rms_mm = 0;   ///< of the markers' positions in the camera frame
  bool agrees = true;  ///< false: the relative positions of the markers do not match the layout

  [[nodiscard]] int count() const;
};

/// Finds the matching with the most markers, each within 4 mm of its place. Of equally good
/// matchings with the same number, it takes the one turned least from `nominal_CF`. Found markers
/// that are not near any place are left out: they were moved, or are not markers.
/// @return a matching with fewer than three markers if there is none
[[nodiscard]] Matching match(const std::vector<FoundMarker>& found, const MarkerLayout& layout,
                             const Pose& nominal_CF);

}  // namespace hydroprint::registration
