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
#include "daemon/store/asset_store.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/job_store.h"
#include "daemon/workers/preview_pool.h"
#include "daemon/workers/worker_pool.h"

namespace hydroprint::daemon {

/// What the services work on.
struct ServiceContext {
  Database& database;
  auth::Accounts& accounts;
  auth::AuditLog& audit;
  const Authenticator& access;
  JobStore& jobs;
  AssetStore& assets;
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
  /// True from the moment the daemon goes down: streams end, nothing new begins.
  const std::atomic<bool>& stopping;
};

/// The name of whoever calls (see Authenticator::caller): what is created is theirs.
[[nodiscard]] Result<std::string> owner_of(const ServiceContext& backend,
                                           const grpc::ServerContextBase& context);

/// Size of a page: the default for 0, at most 1000; negative sizes are refused (SPEC_INVALID).
[[nodiscard]] Result<int> page_size(std::int32_t asked, int otherwise);

/// kUnavailable, SHUTTING_DOWN once the daemon goes down.
[[nodiscard]] Status check_serving(const ServiceContext& backend);

/// Clients try again by themselves what is UNAVAILABLE: for calls that may move the rig, the same
/// error as kAborted, and so is a drive that was busy.
[[nodiscard]] Error never_again(Error error);

/// kInvalidArgument, PAGE_TOKEN_INVALID.
[[nodiscard]] tl::unexpected<Error> bad_page_token();

/// Reads a page token that is a number; 0 for none.
[[nodiscard]] Result<std::int64_t> number_token(const std::string& token);

/// Given one item more than a page holds: drops it, and tells whether it was there.
template <class Items>
[[nodiscard]] bool cut_page(Items& items, int size) {
  if (items.size() <= static_cast<std::size_t>(size)) return false;
  items.resize(static_cast<std::size_t>(size));
  return true;
}

}  // namespace hydroprint::daemon
