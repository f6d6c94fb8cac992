#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/base/pose_uncertainty.h"
#include "sim/calibrate/layout_file.h"
#include "sim/mesh/surface.h"
#include "sim/registration/camera/calibrate_camera.h"
#include "sim/registration/film_frame/water_level.h"
#include "sim/registration/object/object.h"
#include "sim/scan/frame.h"

namespace hydroprint::calibrate {

/// Input of calibrate().
struct Task {
  std::span<const scan::DepthFrame> frames;  ///< frames of a stationary camera
  registration::CameraCalibration camera;
  RigLayout layout;
  mesh::Surface surface;  ///< surface of the object, frame O
  /// nullopt: the model's own orientation, with its bounding box centred on the film.
  std::optional<Pose> nominal_FO;
  std::optional<double> gripper_mm;  ///< height of the gripper's lower end above z = 0
  /// Half the width and height of the region in which the water is measured.
  Eigen::Vector2d half_film_mm{105, 148.5};
};

/// The object's pose, and estimates of its accuracy.
struct Calibration {
  registration::FilmFrame film_frame;
  registration::ObjectPose object;
  std::optional<registration::WaterLevel> water;  ///< nullopt: too little water is in view
  std::vector<Eigen::Vector3d> points_O;          ///< scan points on the object
  /// Distances of points_O from the surface, positive outward.
  std::vector<double> off_mm;
  std::vector<double> error_mm;  ///< registration error at the points of the surface
  PoseUncertainty uncertainty;
  Warnings warnings;
};

/// Returns the error that a share of the surface's points does not exceed, mm; 0 without points.
[[nodiscard]] double error_quantile_mm(std::vector<double> error_mm, double share);

/// Computes the object's pose in the film frame from depth frames (paper, section 5.2). The height
/// of the nominal pose is ignored: the object's top is placed at the gripper's lower end. If the
/// gripper's height is unknown, the object's lowest point is placed 40 mm above the water. Returns
/// the errors of scan::fuse, scan::make_cloud, find_film_frame and find_object.
[[nodiscard]] Result<Calibration> calibrate(const Task& task, const Context& context);

/// Returns a default calibration for a camera that was not calibrated: the driver's lens, with the
/// errors usual for such lenses (first-generation Kinects: Khoshelham and Elberink 2012; Smisek,
/// Jancosek and Pajdla 2011).
[[nodiscard]] registration::CameraCalibration uncalibrated(const scan::Lens& nominal);

/// Returns the warning `CAMERA_NOT_CALIBRATED` if the camera was not calibrated.
[[nodiscard]] Warnings camera_warnings(const registration::CameraCalibration& camera);

}  // namespace hydroprint::calibrate
