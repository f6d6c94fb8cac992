#pragma once

#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/job.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// How a dip would roughly go; the fields are those of the API's Preview, without the mesh.
struct Preview {
  PoseSpec pose;
  double depth_mm = 0;
  double coverage = 0;             ///< share of the surface
  double theta_clamped_share = 0;  ///< of it, where the stretch is not told
  double stretch_p50 = 0, stretch_p95 = 0, stretch_max = 0;
  double seconds = 0;
  Warnings warnings;
};

/// Computes one; of the spec count mesh and what belongs to it, profile, scale, pose, film, depth
/// and speed. Errors: as PreviewService.ComputePreview describes them.
[[nodiscard]] Result<Preview> compute_preview(Connection& connection, const Spec& spec);

}  // namespace hydroprint::client
