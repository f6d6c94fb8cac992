#include "daemon/api/services.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/camera_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

class CameraService final : public v1::CameraService::Service {
 public:
  explicit CameraService(const ServiceContext& backend) : backend_(backend) {}

  grpc::Status GetDepthPicture(grpc::ServerContext* context, const v1::GetDepthPictureRequest*,
                               v1::DepthPicture* reply) override {
    auto picture = backend_.live.recent_picture([context] { return context->IsCancelled(); });
    if (!picture) return to_grpc(picture.error());
    reply->set_png(std::move(picture->png));
    reply->set_width(picture->width);
    reply->set_height(picture->height);
    reply->set_nearest_mm(picture->nearest_mm);
    reply->set_farthest_mm(picture->farthest_mm);
    reply->set_measured_share(picture->measured_share);
    *reply->mutable_time() = time_of(picture->time_ms);
    reply->set_age_s(static_cast<double>(system_clock_ms() - picture->time_ms) / 1000);
    reply->set_camera(picture->camera);
    return grpc::Status::OK;
  }

 private:
  ServiceContext backend_;
};

}  // namespace

std::unique_ptr<grpc::Service> make_camera_service(const ServiceContext& backend) {
  return std::make_unique<CameraService>(backend);
}

}  // namespace hydroprint::daemon
