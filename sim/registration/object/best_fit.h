#pragma once

#include <cstddef>
#include <span>

namespace hydroprint::registration {

/// How well a fitted pose explains a scan.
struct FitQuality {
  double given = 0;          ///< number of points of the scan that were fitted
  double points = 0;         ///< number of them on the surface within their noise
  double misfit_mm = 0;      ///< rms, over blocks of pixels, of the mean distance from the surface
  double misfit_blocks = 0;  ///< number of these blocks
  /// Share of the points farther than 4 mm from the surface, plus the share of the surface that the
  /// camera sees through, plus a tenth of the misfit in mm.
  double mismatch = 0;
  double distance_mm = 0;  ///< rms distance of all points from the surface, each at most 4 mm
  double turn_rad = 0;     ///< angle of the rotation from the nominal pose
};

/// Returns the index of the best fit. Of the fits that explain the scan as well as the best one
/// within noise, as quarter turns of a board do, it is the one with the smallest rotation from the
/// nominal pose. Within noise means within three standard errors of the number of points on the
/// surface, which is binomial, and of the misfit over n independent blocks, 1 / sqrt(2 n) of its
/// value.
/// @param fits  at least one
[[nodiscard]] std::size_t best_fit(std::span<const FitQuality> fits);

}  // namespace hydroprint::registration
