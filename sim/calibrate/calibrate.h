#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/calibrate/layout_file.h"
#include "sim/mesh/surface.h"
#include "sim/registration/camera/calibrate_camera.h"
#include "sim/registration/film_frame/water_level.h"
#include "sim/registration/object/object.h"
#include "sim/scan/frame.h"

namespace hydroprint::calibrate {

/// What calibrate() is told.
struct Task {
  std::span<const scan::DepthFrame> frames;  ///< of a camera that stands still
  registration::CameraCalibration camera;
  RigLayout layout;
  mesh::Surface surface;                     ///< of the object, frame O
  std::optional<Pose> nominal_FO;            ///< none: as it is, its box centred on the film
  std::optional<double> gripper_mm;          ///< height of its lower end over z = 0
  Eigen::Vector2d half_film_mm{105, 148.5};  ///< where the water is looked for
};

/// Where the object hangs, and all that is known of how well.
struct Calibration {
  registration::FilmFrame film_frame;
  registration::ObjectPose object;
  std::optional<registration::WaterLevel> water;  ///< none: too little of it is in view
  std::vector<Eigen::Vector3d> points_O;          ///< of the scan, on the object
  std::vector<double> off_mm;                     ///< of those, outward from its surface
  std::vector<double> error_mm;                   ///< registration error at the surface's points
  Warnings warnings;
};

/// From frames to the object's pose in the film frame (paper, section 5.2). The height of a nominal
/// pose does not count: the object is taken to hang with its top at the gripper's lower end, or, if
/// nobody knows where that is, with its lowest point 40 mm over the water.
/// Refuses what scan::fuse, scan::make_cloud, find_film_frame and find_object refuse.
[[nodiscard]] Result<Calibration> calibrate(const Task& task, const Context& context);

/// A camera that nobody calibrated: what its driver says, and how far off such lenses are (those of
/// first-generation Kinects: Khoshelham and Elberink 2012; Smisek, Jancosek and Pajdla 2011).
[[nodiscard]] registration::CameraCalibration uncalibrated(const scan::Lens& nominal);

/// `camera_not_calibrated`, where nobody did.
[[nodiscard]] Warnings camera_warnings(const registration::CameraCalibration& camera);

}  // namespace hydroprint::calibrate
