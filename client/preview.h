#pragma once

#include "client/connection/connection.h"
#include "hydroprint/v1/preview_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Reads a model for display. Errors: see PreviewService.ReadModel.
[[nodiscard]] Result<v1::DisplayModel> read_model(Connection& connection,
                                                  const v1::InspectSpec& spec);

/// Computes a preview. Uses these fields of the spec: mesh with its files, profile, scale, pose,
/// film, immersion depth and dip speed. Errors: see PreviewService.ComputePreview.
[[nodiscard]] Result<v1::Preview> compute_preview(Connection& connection,
                                                  const v1::SimulateSpec& spec);

}  // namespace hydroprint::client
