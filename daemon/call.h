#pragma once

#include <grpcpp/server_context.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <string>

#include "daemon/access.h"
#include "daemon/asset_store.h"
#include "daemon/calibration_store.h"
#include "daemon/capture_runner.h"
#include "daemon/dip_runner.h"
#include "daemon/job_store.h"
#include "daemon/live_camera.h"
#include "daemon/people/audit.h"
#include "daemon/pool.h"
#include "daemon/preview_desk.h"
#include "daemon/print_runner.h"
#include "daemon/rig_desk.h"

namespace hydroprint::daemon {

/// What the services work on.
struct Backend {
  Database& database;
  people::Accounts& accounts;
  people::AuditLog& audit;
  const Access& access;
  JobStore& jobs;
  AssetStore& assets;
  WorkerPool& pool;
  RigDesk& desk;
  DipRunner& dips;
  PrintRunner& prints;
  CaptureRunner& captures;
  CalibrationStore& calibrations;
  PreviewDesk& previews;
  LiveCamera& live;
  PlaceKeeper& places;
  CameraSetup camera;
  Layout layout;
  std::int64_t min_free_bytes = 0;
  Quota quota;
  /// True from the moment the daemon goes down: streams end, nothing new begins.
  const std::atomic<bool>& stopping;
};

/// The name of whoever calls (see Access::caller): what is created is theirs.
[[nodiscard]] Result<std::string> owner_of(const Backend& backend,
                                           const grpc::ServerContextBase& context);

/// Size of a page: the default for 0, at most 1000; negative sizes are refused (SPEC_INVALID).
[[nodiscard]] Result<int> page_size(std::int32_t asked, int otherwise);

/// kUnavailable, SHUTTING_DOWN once the daemon goes down.
[[nodiscard]] Status check_serving(const Backend& backend);

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
