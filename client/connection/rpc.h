#pragma once

// Private to this library: how one call is made. Included by .cpp files only.

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "client/connection/connection.h"
#include "hydroprint/v1/artifact_service.grpc.pb.h"
#include "hydroprint/v1/asset_service.grpc.pb.h"
#include "hydroprint/v1/calibration_service.grpc.pb.h"
#include "hydroprint/v1/camera_service.grpc.pb.h"
#include "hydroprint/v1/job_service.grpc.pb.h"
#include "hydroprint/v1/lease_service.grpc.pb.h"
#include "hydroprint/v1/people_service.grpc.pb.h"
#include "hydroprint/v1/preview_service.grpc.pb.h"
#include "hydroprint/v1/queue_service.grpc.pb.h"
#include "hydroprint/v1/rig_service.grpc.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

namespace v1 = ::hydroprint::v1;

struct Connection::Impl {
  explicit Impl(ConnectionOptions connection_options);

  ConnectionOptions options;
  std::shared_ptr<grpc::Channel> channel;
  bool keeps_secrets;  ///< check_secrets_may_go()
  std::unique_ptr<v1::ArtifactService::Stub> artifacts;
  std::unique_ptr<v1::AssetService::Stub> assets;
  std::unique_ptr<v1::CalibrationService::Stub> calibrations;
  std::unique_ptr<v1::CameraService::Stub> cameras;
  std::unique_ptr<v1::JobService::Stub> jobs;
  std::unique_ptr<v1::LeaseService::Stub> leases;
  std::unique_ptr<v1::PeopleService::Stub> people;
  std::unique_ptr<v1::PreviewService::Stub> previews;
  std::unique_ptr<v1::QueueService::Stub> queue;
  std::unique_ptr<v1::RigService::Stub> rig;
};

/// What every call carries: who makes it, a time limit, and an end when the connection is to stop.
class Call {
 public:
  explicit Call(Connection& connection);
  /// As above, and ends after `limit`.
  Call(Connection& connection, std::chrono::milliseconds limit);

  [[nodiscard]] grpc::ClientContext* context() { return &context_; }

 private:
  grpc::ClientContext context_;
  std::stop_callback<std::function<void()>> on_stop_;
};

/// Time within which a call that does not stream must be answered.
inline constexpr std::chrono::seconds kAnswerLimit{30};
/// Time within which there must be a connection for a call or a stream that is not repeated.
inline constexpr std::chrono::seconds kConnectLimit{1};
/// Between attempts at a stream that broke off.
inline constexpr std::chrono::milliseconds kTryAgainAfter{500};
/// After which a transfer in which nothing arrives is given up.
inline constexpr int kAttemptsWithoutProgress = 5;
/// What a list is asked for at once.
inline constexpr int kPageSize = 1000;

/// The error that a failed call means, with the reason from its google.rpc.ErrorInfo.
[[nodiscard]] Error to_error(const Connection& connection, const grpc::Status& status);

/// Runs `attempt` until it answers anything but UNAVAILABLE, a few times with growing pauses.
[[nodiscard]] grpc::Status with_retries(Connection& connection,
                                        const std::function<grpc::Status()>& attempt);

/// Waits until there is a connection, or that long. (gRPC goes on with a connection that it has
/// begun only while somebody waits for it; calls alone, which fail at once, never get to see it.)
void wait_for_connection(Connection& connection, std::chrono::milliseconds time);

/// Waits that long, or until the connection is to stop.
void pause(const Connection& connection, std::chrono::milliseconds time);

/// One call that may safely be repeated.
template <class Stub, class Request, class Response>
[[nodiscard]] Result<Response> call(Connection& connection, Stub& stub,
                                    grpc::Status (Stub::*method)(grpc::ClientContext*,
                                                                 const Request&, Response*),
                                    const Request& request) {
  Response response;
  const grpc::Status status = with_retries(connection, [&] {
    Call one(connection, kAnswerLimit);
    response.Clear();
    return (stub.*method)(one.context(), request, &response);
  });
  if (!status.ok()) return tl::unexpected(to_error(connection, status));
  return response;
}

/// One call that is never repeated: whoever moves the rig has to see first what became of it.
template <class Stub, class Request, class Response>
[[nodiscard]] Result<Response> call_once(Connection& connection, Stub& stub,
                                         grpc::Status (Stub::*method)(grpc::ClientContext*,
                                                                      const Request&, Response*),
                                         const Request& request,
                                         std::chrono::milliseconds limit = kAnswerLimit) {
  Response response;
  wait_for_connection(connection, kConnectLimit);
  Call one(connection, limit);
  const grpc::Status status = (stub.*method)(one.context(), request, &response);
  if (!status.ok()) return tl::unexpected(to_error(connection, status));
  return response;
}

}  // namespace hydroprint::client
