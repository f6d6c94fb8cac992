#include "client/preview.h"

#include "client/connection/rpc.h"
#include "client/convert.h"

namespace hydroprint::client {

Result<Preview> compute_preview(Connection& connection, const Spec& spec) {
  v1::Job job;
  HP_RETURN_IF_ERROR(to_proto(spec, job));
  v1::ComputePreviewRequest request;
  *request.mutable_simulate() = job.simulate();
  HP_ASSIGN_OR_RETURN(const v1::Preview answer,
                      call(connection, *connection.impl().previews,
                           &v1::PreviewService::Stub::ComputePreview, request));
  Preview out;
  if (const auto pose = pose_from_proto(answer.pose())) out.pose = *pose;
  out.depth_mm = answer.depth_mm();
  out.coverage = answer.coverage();
  out.theta_clamped_share = answer.theta_clamped_share();
  out.stretch_p50 = answer.stretch_p50();
  out.stretch_p95 = answer.stretch_p95();
  out.stretch_max = answer.stretch_max();
  out.seconds = answer.seconds();
  for (const auto& told : answer.warnings()) {
    out.warnings.push_back({told.code(), told.message(), told.where()});
  }
  return out;
}

}  // namespace hydroprint::client
