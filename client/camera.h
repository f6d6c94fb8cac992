#pragma once

#include "client/connection/connection.h"
#include "hydroprint/v1/camera_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Returns the current picture; waits some seconds while the camera starts. Errors: see
/// CameraService.GetDepthPicture.
[[nodiscard]] Result<v1::DepthPicture> depth_picture(Connection& connection);

}  // namespace hydroprint::client
