#pragma once

#include <grpcpp/server_context.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <string>

#include "daemon/auth/audit_log.h"
#include "daemon/auth/authenticator.h"
#include "daemon/camera/capture_executor.h"
#include "daemon/camera/live_camera.h"
#include "daemon/dip/executor.h"
#include "daemon/jobs/executor.h"
#include "daemon/rig/rig_gateway.h"
#include "daemon/store/assets/uploads.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/job_queue.h"
#include "daemon/store/job_retention.h"
#include "daemon/store/job_store.h"
#include "daemon/workers/preview_pool.h"
#include "daemon/workers/worker_pool.h"

namespace hydroprint::daemon {

/// The objects that the services use.
struct ServiceContext {
  Database& database;
  auth::Accounts& accounts;
  auth::AuditLog& audit;
  const Authenticator& access;
  JobStore& jobs;
  JobQueue& queue;
  JobRetention& retention;
  AssetStore& assets;
  Uploads& uploads;
  WorkerPool& pool;
  RigGateway& gateway;
  DipExecutor& dips;
  CaptureExecutor& captures;
  Executors executors;
  CalibrationStore& calibrations;
  PreviewPool& previews;
  LiveCamera& live;
  RigReference& places;
  CameraConfig camera;
  Layout layout;
  std::int64_t min_free_bytes = 0;
  Quota quota;
  /// True once the daemon starts to shut down: streams end, and new calls are rejected.
  const std::atomic<bool>& stopping;
};

/// Returns the name of the caller (see Authenticator::caller), who will own the created resources.
[[nodiscard]] Result<std::string> owner_of(const grpc::ServerContextBase& context);

/// Returns the page size: the default for 0, at most 1000; SPEC_INVALID if negative.
[[nodiscard]] Result<int> page_size(std::int32_t size, int default_size);

/// Returns kUnavailable, SHUTTING_DOWN if the daemon is shutting down.
[[nodiscard]] Status check_serving(const ServiceContext& backend);

/// Converts UNAVAILABLE (also from a busy drive) to kAborted for calls that may move the rig,
/// because clients retry UNAVAILABLE automatically.
[[nodiscard]] Error never_again(Error error);

/// Returns the error kInvalidArgument, PAGE_TOKEN_INVALID.
[[nodiscard]] tl::unexpected<Error> bad_page_token();

/// Parses a numeric page token; 0 for an empty token.
[[nodiscard]] Result<std::int64_t> number_token(const std::string& token);

/// Shortens a list, which was read with one item more than the page size, to that size. Returns
/// whether it was longer, and so another page exists.
template <class Items>
[[nodiscard]] bool cut_page(Items& items, int size) {
  if (items.size() <= static_cast<std::size_t>(size)) return false;
  items.resize(static_cast<std::size_t>(size));
  return true;
}

}  // namespace hydroprint::daemon
