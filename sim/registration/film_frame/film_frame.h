#pragma once

#include <string>
#include <vector>

#include "sim/registration/film_frame/markers.h"

namespace hydroprint::registration {

/// The result for one marker.
struct MarkerReport {
  std::string name;
  bool used = false;
  /// Rms distance of the marker's points from its surface, in the fit of all markers.
  double rms_mm = 0;
  /// Distance of the marker, fitted alone, from its place in the fit of all markers.
  double residual_mm = 0;
  std::string why_not;  ///< why the marker is not used: hidden, displaced or of another shape
};

/// The film frame, found from the markers.
struct FilmFrame {
  PoseFit fit;                        ///< pose of F in the camera frame
  std::vector<MarkerReport> markers;  ///< reports in the layout's order
  Warnings warnings;                  ///< `MARKER_LEFT_OUT` for each unused marker

  [[nodiscard]] const Pose& X_CF() const { return fit.X_CB; }
  /// Returns the derivative of `motion` times the frame's twist with respect to the camera's
  /// unknowns; zero if the frame was not found with a camera.
  template <int Rows>
  [[nodiscard]] Eigen::Matrix<double, Rows, Eigen::Dynamic> camera_gain(
      const Eigen::Matrix<double, Rows, 6>& motion, Eigen::Index unknowns) const {
    if (fit.camera_gain.cols() == 0)
      return Eigen::Matrix<double, Rows, Eigen::Dynamic>::Zero(Rows, unknowns);
    return motion * fit.camera_gain;
  }
};

/// Finds the markers (find_markers), identifies them by the distances between them (match), drops
/// those that disagree with the layout (agreeing), and fits all others together. Returns
/// kInvalidArgument if the layout has fewer than three markers. Returns kFailedPrecondition
/// (TOO_FEW_MARKERS) if fewer than three can be used, or if three do not agree; the message states
/// the problem of each marker. Also returns the errors of find_plane().
/// @param nominal_CF  the film's pose in the rig's configuration, accurate to about 30 degrees. It
///                    defines up, and distinguishes the two ends of a symmetrical layout
[[nodiscard]] Result<FilmFrame> find_film_frame(const scan::Cloud& cloud,
                                                const MarkerLayout& layout, const Pose& nominal_CF,
                                                const Context& context);

}  // namespace hydroprint::registration
