#include "client/camera.h"

#include "client/connection/rpc.h"

namespace hydroprint::client {

Result<v1::DepthPicture> depth_picture(Connection& connection) {
  return call(connection, *connection.impl().cameras, &v1::CameraService::Stub::GetDepthPicture,
              v1::GetDepthPictureRequest());
}

}  // namespace hydroprint::client
