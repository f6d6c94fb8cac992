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

/// What goes into the water, as the bundled samples have it.
struct Body {
  std::string name;                     ///< of the sample
  Eigen::Matrix3d nominal_turn;         ///< how it should hang, F
  bool is_round = false;                ///< a sphere: no scan tells its turn, so that stays nominal
  std::vector<Eigen::Vector3d> points;  ///< of its mesh, O
};

/// "board" (held at 30 degrees, as in section 7.1) or "sphere80". Refuses others
/// (kInvalidArgument).
[[nodiscard]] Result<Body> make_body(const std::string& name);

/// What a rig does that its operator does not know; all of it drawn evenly within the bounds of a
/// careful build.
struct Truth {
  Pose X_GO = Pose::Identity();   ///< how the object hangs in the gripper (origin: its lower end)
  Eigen::Vector2d slope{0, 0};    ///< of the motion axis: mm sideways for each mm down
  Eigen::Vector2d film_mm{0, 0};  ///< how far off the film lies
  double printer_scale = 1;       ///< of what is printed
};

inline constexpr double kMostTilt_deg = 5;     ///< of the object
inline constexpr double kMostShift_mm = 4;     ///< of the object, each way
inline constexpr double kMostSlope_deg = 0.2;  ///< of the axis off vertical
inline constexpr double kMostFilm_mm = 0.3;    ///< of the film's placement
inline constexpr double kMostScale = 0.001;    ///< of the printer's scale off 1

/// The truth number `index` of a seed; the same every time.
[[nodiscard]] Truth draw(const Body& body, std::uint32_t seed, int index);

/// The pose that everybody believes in before calibration: straight, its box centred.
[[nodiscard]] Pose nominal_pose(const Body& body);

/// Where the object is (F) when its lowest point meets the water, hanging as `truth` says, the axis
/// having come down from where the gripper's lower end was `gripper_mm` over the water.
[[nodiscard]] Pose pose_at_contact(const Body& body, const Truth& truth, double gripper_mm);

/// How high over the water the object's lowest point is with the gripper there.
[[nodiscard]] double height_mm(const Body& body, const Truth& truth, double gripper_mm);

/// How somebody holds the calibration board before the camera, the index-th time: X_CB, in turn
/// towards the image's corners, near and far, tilted each way, always whole in view.
[[nodiscard]] Pose held_board(std::uint32_t seed, int index);

/// That board (registration::calibration_board()) as an OBJ file, mm.
[[nodiscard]] std::string board_obj();

/// As pose files have it.
[[nodiscard]] std::string pose_json(const Pose& pose);

}  // namespace hydroprint::loop
