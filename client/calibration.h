#pragma once

#include <string>

#include "client/connection/connection.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Lists calibrations, newest first.
[[nodiscard]] Result<v1::ListCalibrationsResponse> list_calibrations(Connection& connection,
                                                                     int limit);

/// Returns a calibration.
/// @param name  "calibrations/3", or "calibrations/active"
[[nodiscard]] Result<v1::Calibration> get_calibration(Connection& connection,
                                                      const std::string& name);

/// Creates a calibration from values entered by hand: mesh, scale, film and pose.
[[nodiscard]] Result<v1::Calibration> create_calibration(Connection& connection,
                                                         const v1::Calibration& entered);

/// Makes this calibration the default of its kind.
[[nodiscard]] Result<v1::Calibration> activate_calibration(Connection& connection,
                                                           const std::string& name);

[[nodiscard]] Status delete_calibration(Connection& connection, const std::string& name);

}  // namespace hydroprint::client
