#pragma once

#include <optional>
#include <string>

#include "client/connection/connection.h"
#include "client/time.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// What the daemon's depth camera sees; the fields are those of the API's DepthPicture.
struct DepthPicture {
  std::string png;  ///< a PNG file: the nearer the brighter, grey where nothing was measured
  double nearest_mm = 0, farthest_mm = 0;
  double measured_share = 0;
  std::optional<Time> time;
  double age_s = 0;
  std::string camera;  ///< maker and model
};

/// What it sees now; waits some seconds while it starts. Errors: as CameraService.GetDepthPicture
/// describes them.
[[nodiscard]] Result<DepthPicture> depth_picture(Connection& connection);

}  // namespace hydroprint::client
