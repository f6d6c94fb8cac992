#pragma once

#include <vector>

#include "sim/registration/film_frame/markers.h"

namespace hydroprint::registration {

/// Which found marker is which of the layout.
struct Matching {
  std::vector<int> found;  ///< per marker of the layout: index of what was found, -1: none
  Pose X_CF = Pose::Identity();
  double rms_mm = 0;   ///< of places in the camera frame
  bool agrees = true;  ///< false: those that are left do not stand to each other as they should

  [[nodiscard]] int count() const;
};

/// The matching that explains most places, to within 4 mm; of those that explain as many about as
/// well, the one turned least from `nominal_CF`. Found markers that stand nowhere near where the
/// layout has one are left out: they were moved, or are none.
/// @return with fewer than three markers if there is none
[[nodiscard]] Matching match(const std::vector<FoundMarker>& found, const MarkerLayout& layout,
                             const Pose& nominal_CF);

}  // namespace hydroprint::registration
