#pragma once

#include "client/connection/connection.h"
#include "hydroprint/v1/preview_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Computes a preview. Uses these parts of the spec: mesh with its files, profile, scale, pose,
/// film, depth and speed. Errors: as PreviewService.ComputePreview describes them.
[[nodiscard]] Result<v1::Preview> compute_preview(Connection& connection,
                                                  const v1::SimulateSpec& spec);

}  // namespace hydroprint::client
