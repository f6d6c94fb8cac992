#pragma once

#include <vector>

#include "sim/registration/film_frame/markers.h"

namespace hydroprint::registration {

/// An assignment of detected markers to markers of the layout.
struct Matching {
  /// For each marker of the layout, the index of the detected marker; -1: none.
  std::vector<int> found;
  Pose X_CF = Pose::Identity();
  double rms_mm = 0;   ///< rms error of the markers' positions in the camera frame
  bool agrees = true;  ///< false: the relative positions of the markers do not match the layout

  [[nodiscard]] int count() const;
};

/// Finds the matching with the most markers, each within 4 mm of its place. If several have the
/// same number and nearly the same rms error, returns the one with the smallest rotation from
/// `nominal_CF`. Detected markers that
/// are not near any place are dropped: they were displaced, or are not markers.
/// @return a matching with fewer than three markers if none is found
[[nodiscard]] Matching match(const std::vector<FoundMarker>& found, const MarkerLayout& layout,
                             const Pose& nominal_CF);

}  // namespace hydroprint::registration
