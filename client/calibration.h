#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/job.h"
#include "client/time.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// The result for one marker.
struct CalibrationMarker {
  std::string name;
  bool used = false;
  std::string why_not;
  double rms_mm = 0;
  double residual_mm = 0;
};

/// A measured pose of an object, or a camera's lens; the fields are those of the API's Calibration.
struct Calibration {
  std::string name;  ///< "calibrations/3"
  std::string kind;  ///< "OBJECT", "CAMERA"
  std::string display_name;
  std::string owner;
  std::optional<Time> create_time;
  std::optional<Time> capture_time;
  bool active = false;
  std::string job;                 ///< job that produced it; empty: entered by hand
  std::string picture;             ///< "jobs/7/artifacts/alignment.png"
  std::vector<std::string> stale;  ///< "MOVED", "HOMED", "DIPPED"
  InputFile mesh;
  double scale = 1;
  std::string film;
  std::optional<PoseSpec> pose;
  /// 6 x 6, row-major: rotation (rad), translation (mm) about centre_mm.
  std::vector<double> covariance;
  std::vector<double> centre_mm;
  std::optional<double> error_p50_mm, error_p95_mm, error_max_mm;  ///< on the object's surface
  std::vector<std::string> from_nominal_pose;  ///< motions that the scan cannot determine
  std::vector<CalibrationMarker> markers;
  std::optional<double> water_z_mm, water_sigma_mm;
  std::optional<double> height_mm;   ///< of the lowest point above the water
  std::optional<double> axis_mm;     ///< axis position during the capture
  std::optional<double> contact_mm;  ///< axis position at first contact
  int views = 0;                     ///< camera only
  double rms_mm = 0;                 ///< camera only
};

/// Lists calibrations, newest first.
[[nodiscard]] Result<std::vector<Calibration>> list_calibrations(Connection& connection, int limit);

/// @param name  "calibrations/3", or "calibrations/active"
[[nodiscard]] Result<Calibration> get_calibration(Connection& connection, const std::string& name);

/// Creates a calibration from values entered by hand. Reads `display_name`, `mesh`, `scale`, `film`
/// and `pose` only.
[[nodiscard]] Result<Calibration> create_calibration(Connection& connection,
                                                     const Calibration& entered);

/// Makes this calibration the default of its kind.
[[nodiscard]] Result<Calibration> activate_calibration(Connection& connection,
                                                       const std::string& name);

[[nodiscard]] Status delete_calibration(Connection& connection, const std::string& name);

}  // namespace hydroprint::client
