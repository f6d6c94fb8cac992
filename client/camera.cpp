#include "client/camera.h"

#include "client/connection/rpc.h"
#include "client/convert.h"

namespace hydroprint::client {

Result<DepthPicture> depth_picture(Connection& connection) {
  HP_ASSIGN_OR_RETURN(v1::DepthPicture seen, call(connection, *connection.impl().cameras,
                                                  &v1::CameraService::Stub::GetDepthPicture,
                                                  v1::GetDepthPictureRequest()));
  DepthPicture out;
  out.png = std::move(*seen.mutable_png());
  out.nearest_mm = seen.nearest_mm();
  out.farthest_mm = seen.farthest_mm();
  out.measured_share = seen.measured_share();
  out.time = from_proto(seen.has_time(), seen.time());
  out.age_s = seen.age_s();
  out.camera = seen.camera();
  return out;
}

}  // namespace hydroprint::client
