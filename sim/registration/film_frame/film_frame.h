#pragma once

#include <string>
#include <vector>

#include "sim/registration/film_frame/markers.h"

namespace hydroprint::registration {

/// What became of one marker.
struct MarkerReport {
  std::string name;
  bool used = false;
  double rms_mm = 0;       ///< of its points from its surface, in the frame of all
  double residual_mm = 0;  ///< of its own place from where the frame of all puts it
  std::string why_not;     ///< where it is not used: hidden, moved, not its shape
};

/// The film frame as the markers tell it.
struct FilmFrame {
  PoseFit fit;                        ///< of F in the camera frame
  std::vector<MarkerReport> markers;  ///< in the layout's order
  Warnings warnings;                  ///< `marker_left_out`, one each

  [[nodiscard]] const Pose& X_CF() const { return fit.X_CB; }
  /// How `motion` of the frame's twist goes with the camera's unknowns; nothing of a frame that no
  /// camera found.
  template <int Rows>
  [[nodiscard]] Eigen::Matrix<double, Rows, Eigen::Dynamic> camera_gain(
      const Eigen::Matrix<double, Rows, 6>& motion, Eigen::Index unknowns) const {
    if (fit.camera_gain.cols() == 0)
      return Eigen::Matrix<double, Rows, Eigen::Dynamic>::Zero(Rows, unknowns);
    return motion * fit.camera_gain;
  }
};

/// Finds the markers (find_markers), tells which is which by the distances between them (match),
/// leaves out those that do not stand where the layout says (agreeing), and fits all others
/// together.
/// @param nominal_CF  where the rig's configuration has the film, to some 30 degrees: it tells up,
///                    and which end is which of a layout that looks the same turned round
/// Refuses with kInvalidArgument a layout of fewer than three markers, with kFailedPrecondition
/// what find_plane refuses, and TOO_FEW_MARKERS where fewer than three can be used or three do not
/// agree, saying what is wrong with each.
[[nodiscard]] Result<FilmFrame> find_film_frame(const scan::Cloud& cloud,
                                                const MarkerLayout& layout, const Pose& nominal_CF,
                                                const Context& context);

}  // namespace hydroprint::registration
