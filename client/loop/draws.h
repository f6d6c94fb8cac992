#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "sim/base/pose.h"
#include "sim/base/result.h"

namespace hydroprint::loop {

inline constexpr double kDegree = std::numbers::pi / 180;

/// The object to dip, one of the bundled samples.
struct Body {
  std::string name;              ///< name of the sample
  Eigen::Matrix3d nominal_turn;  ///< nominal orientation, F
  /// whether it is a sphere, which keeps its nominal rotation because a scan cannot measure it
  bool is_round = false;
  std::vector<Eigen::Vector3d> points;  ///< vertices of its mesh, O
};

/// Creates the object "board" (held at 30 degrees, as in section 7.1 of the paper) or "sphere80".
/// Errors: kInvalidArgument for other names.
[[nodiscard]] Result<Body> make_body(const std::string& name);

/// Errors of a rig that its operator does not know, drawn uniformly within the limits of a
/// carefully built rig.
struct Truth {
  Pose X_GO = Pose::Identity();   ///< pose of the object in the gripper (origin: its lower end)
  Eigen::Vector2d slope{0, 0};    ///< horizontal motion of the axis for each mm down
  Eigen::Vector2d film_mm{0, 0};  ///< displacement of the film
  double printer_scale = 1;       ///< scale of the printed image
};

inline constexpr double kMostTilt_deg = 5;     ///< maximum tilt of the object
inline constexpr double kMostShift_mm = 4;     ///< maximum shift of the object in each direction
inline constexpr double kMostSlope_deg = 0.2;  ///< maximum deviation of the axis from vertical
inline constexpr double kMostFilm_mm = 0.3;    ///< maximum displacement of the film
inline constexpr double kMostScale = 0.001;    ///< maximum deviation of the printer's scale from 1

/// Draws the errors for pose number `index`. The result depends only on the arguments.
[[nodiscard]] Truth draw(const Body& body, std::uint32_t seed, int index);

/// Returns the assumed pose before calibration: upright, with its bounding box centred.
[[nodiscard]] Pose nominal_pose(const Body& body);

/// Returns the object's pose (F) at first contact if it is mounted as in `truth`. `gripper_mm` is
/// the height of the gripper's lower end above the water before the axis was lowered.
[[nodiscard]] Pose pose_at_contact(const Body& body, const Truth& truth, double gripper_mm);

/// Returns the height of the object's lowest point above the water if the gripper's lower end is at
/// `gripper_mm`.
[[nodiscard]] double height_mm(const Body& body, const Truth& truth, double gripper_mm);

/// Returns the pose X_CB of the calibration board for capture number `index`. The poses are near
/// each corner of the image in turn, near and far, tilted in each direction, and always fully in
/// view.
[[nodiscard]] Pose held_board(std::uint32_t seed, int index);

/// Returns the calibration board (registration::calibration_board()) as an OBJ file, mm.
[[nodiscard]] std::string board_obj();

/// Returns the content of a pose file.
[[nodiscard]] std::string pose_json(const Pose& pose);

}  // namespace hydroprint::loop
