#include "client/preview.h"

#include "client/connection/rpc.h"

namespace hydroprint::client {

Result<v1::DisplayModel> read_model(Connection& connection, const v1::InspectSpec& spec) {
  v1::ReadModelRequest request;
  *request.mutable_inspect() = spec;
  return call(connection, *connection.impl().previews, &v1::PreviewService::Stub::ReadModel,
              request);
}

Result<v1::Preview> compute_preview(Connection& connection, const v1::SimulateSpec& spec) {
  v1::ComputePreviewRequest request;
  *request.mutable_simulate() = spec;
  return call(connection, *connection.impl().previews, &v1::PreviewService::Stub::ComputePreview,
              request);
}

}  // namespace hydroprint::client
