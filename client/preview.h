#pragma once

#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/job.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// A rough prediction of a dip; the fields are those of the API's Preview, without the mesh.
struct Preview {
  PoseSpec pose;
  double depth_mm = 0;
  double coverage = 0;             ///< share of the surface that film reaches
  double theta_clamped_share = 0;  ///< share of the covered surface with unknown stretch
  double stretch_p50 = 0, stretch_p95 = 0, stretch_max = 0;
  double seconds = 0;
  Warnings warnings;
};

/// Computes a preview. Uses these parts of the spec: mesh with its files, profile, scale, pose,
/// film, depth and speed. Errors: as PreviewService.ComputePreview describes them.
[[nodiscard]] Result<Preview> compute_preview(Connection& connection, const Spec& spec);

}  // namespace hydroprint::client
