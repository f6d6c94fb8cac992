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

/// Input of calibrate().
struct Task {
  std::span<const scan::DepthFrame> frames;  ///< from a stationary camera
  registration::CameraCalibration camera;
  RigLayout layout;
  mesh::Surface surface;  ///< of the object, frame O
  /// nullopt: model orientation, box centred on the film.
  std::optional<Pose> nominal_FO;
  std::optional<double> gripper_mm;          ///< height of its lower end above z = 0
  Eigen::Vector2d half_film_mm{105, 148.5};  ///< the region searched for water
};

/// The object's pose, and all figures on its accuracy.
struct Calibration {
  registration::FilmFrame film_frame;
  registration::ObjectPose object;
  std::optional<registration::WaterLevel> water;  ///< nullopt: too little of it is in view
  std::vector<Eigen::Vector3d> points_O;          ///< of the scan, on the object
  /// Their distances from its surface, positive outward.
  std::vector<double> off_mm;
  std::vector<double> error_mm;  ///< registration error at the surface's points
  Warnings warnings;
};

/// From frames to the object's pose in the film frame (paper, section 5.2). The height of the
/// nominal pose is replaced: the object's top is put at the gripper's lower end. If the gripper's
/// height is unknown, the object's lowest point is put 40 mm above the water.
/// Fails as scan::fuse, scan::make_cloud, find_film_frame and find_object do.
[[nodiscard]] Result<Calibration> calibrate(const Task& task, const Context& context);

/// The calibration of a camera that was not calibrated: the driver's lens, with the errors usual
/// for such lenses (first-generation Kinects: Khoshelham and Elberink 2012; Smisek, Jancosek and
/// Pajdla 2011).
[[nodiscard]] registration::CameraCalibration uncalibrated(const scan::Lens& nominal);

/// `camera_not_calibrated`, if the camera was not calibrated.
[[nodiscard]] Warnings camera_warnings(const registration::CameraCalibration& camera);

}  // namespace hydroprint::calibrate
