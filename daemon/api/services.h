#pragma once

#include <grpcpp/impl/service_type.h>

#include <memory>

#include "daemon/api/service_context.h"

namespace hydroprint::daemon {

/// The services of proto/hydroprint/v1, where each method is documented. They check requests, call
/// the stores and convert the results to messages.
[[nodiscard]] std::unique_ptr<grpc::Service> make_job_service(const ServiceContext& backend);
[[nodiscard]] std::unique_ptr<grpc::Service> make_queue_service(const ServiceContext& backend);
[[nodiscard]] std::unique_ptr<grpc::Service> make_asset_service(const ServiceContext& backend);
[[nodiscard]] std::unique_ptr<grpc::Service> make_artifact_service(const ServiceContext& backend);
[[nodiscard]] std::unique_ptr<grpc::Service> make_calibration_service(
    const ServiceContext& backend);
[[nodiscard]] std::unique_ptr<grpc::Service> make_preview_service(const ServiceContext& backend);
[[nodiscard]] std::unique_ptr<grpc::Service> make_camera_service(const ServiceContext& backend);
[[nodiscard]] std::unique_ptr<grpc::Service> make_rig_service(const ServiceContext& backend);
[[nodiscard]] std::unique_ptr<grpc::Service> make_lease_service(const ServiceContext& backend);
[[nodiscard]] std::unique_ptr<grpc::Service> make_event_service(const ServiceContext& backend);
[[nodiscard]] std::unique_ptr<grpc::Service> make_people_service(const ServiceContext& backend);

}  // namespace hydroprint::daemon
