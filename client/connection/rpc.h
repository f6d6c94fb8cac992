#pragma once

// Internal: the mechanics of a call. Include in .cpp files only.

#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
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

struct Connection::Impl {
  explicit Impl(ConnectionOptions connection_options);

  ConnectionOptions options;
  std::shared_ptr<grpc::Channel> channel;
  bool keeps_secrets;  ///< passwords and keys may be sent; see check_secrets_may_go()
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

/// The context of a call: the caller's identity, a time limit, and cancellation by the stop token.
class Call {
 public:
  explicit Call(Connection& connection);
  /// Same as above, with a deadline `limit` from now.
  Call(Connection& connection, std::chrono::milliseconds limit);

  [[nodiscard]] grpc::ClientContext* context() { return &context_; }

 private:
  grpc::ClientContext context_;
  std::stop_callback<std::function<void()>> on_stop_;
};

/// Deadline of a call that does not stream.
inline constexpr std::chrono::seconds kAnswerLimit{30};
/// Deadline for connecting, for calls and streams that are not repeated.
inline constexpr std::chrono::seconds kConnectLimit{1};
/// Pause between attempts to resume a broken stream.
inline constexpr std::chrono::milliseconds kTryAgainAfter{500};
/// Number of attempts without progress after which a transfer fails.
inline constexpr int kAttemptsWithoutProgress = 5;
/// Largest page size of list requests.
inline constexpr int kPageSize = 1000;

/// Converts a failed call's status to an error, with the reason from its google.rpc.ErrorInfo.
[[nodiscard]] Error to_error(const Connection& connection, const grpc::Status& status);

/// Runs `attempt` up to a few times, with growing pauses, until it returns a status other than
/// UNAVAILABLE.
[[nodiscard]] grpc::Status with_retries(Connection& connection,
                                        const std::function<grpc::Status()>& attempt);

/// Waits until there is a connection, at most for `time`. Without a connection, calls fail
/// immediately, and gRPC completes a connection only while a thread waits for it.
void wait_for_connection(Connection& connection, std::chrono::milliseconds time);

/// Waits for `time`, or until the connection is stopped.
void pause(const Connection& connection, std::chrono::milliseconds time);

/// Makes a call that is safe to repeat.
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

/// Makes a call that is never repeated. For example, a command to the rig must not be sent again
/// before the result of the first attempt is known.
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

/// Requests pages until there are `limit` items or no further page, and joins them. The result has
/// the page token of the last page.
/// @param count  number of items in a response, for example &v1::ListJobsResponse::jobs_size
template <class Stub, class Request, class Response>
[[nodiscard]] Result<Response> all_pages(Connection& connection, Stub& stub,
                                         grpc::Status (Stub::*method)(grpc::ClientContext*,
                                                                      const Request&, Response*),
                                         Request request, int (Response::*count)() const,
                                         int limit = std::numeric_limits<int>::max()) {
  Response all;
  do {
    request.set_page_size(std::min(kPageSize, limit - (all.*count)()));
    HP_ASSIGN_OR_RETURN(const Response page, call(connection, stub, method, request));
    all.MergeFrom(page);
    all.set_next_page_token(page.next_page_token());
    request.set_page_token(page.next_page_token());
  } while (!all.next_page_token().empty() && (all.*count)() < limit);
  return all;
}

/// Creates a request with the name of a resource.
template <class Request>
[[nodiscard]] Request named(const std::string& name) {
  Request request;
  request.set_name(name);
  return request;
}

}  // namespace hydroprint::client
