#pragma once

#include "client/connection/connection.h"
#include "hydroprint/v1/camera_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Returns the current depth picture. If the camera has to start first, waits for up to 5 s.
/// Errors: see CameraService.GetDepthPicture.
[[nodiscard]] Result<v1::DepthPicture> depth_picture(Connection& connection);

}  // namespace hydroprint::client
