#pragma once

#include <optional>
#include <string>

#include "client/connection/connection.h"
#include "client/time.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// A depth picture from the daemon's camera; the fields are those of the API's DepthPicture.
struct DepthPicture {
  std::string png;  ///< PNG file: nearer is brighter, grey where nothing was measured
  double nearest_mm = 0, farthest_mm = 0;
  double measured_share = 0;
  std::optional<Time> time;
  double age_s = 0;
  std::string camera;  ///< maker and model
};

/// Returns the current picture; waits some seconds while the camera starts. Errors: as
/// CameraService.GetDepthPicture describes them.
[[nodiscard]] Result<DepthPicture> depth_picture(Connection& connection);

}  // namespace hydroprint::client
