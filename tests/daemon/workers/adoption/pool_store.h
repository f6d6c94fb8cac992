#pragma once

#include <filesystem>
#include <memory>

#include "daemon/store/database/schema.h"
#include "daemon/store/job_queue.h"
#include "daemon/store/job_retention.h"
#include "daemon/store/job_store.h"

namespace hydroprint::daemon {

/// The store of a daemon that runs workers.
struct PoolStore {
  explicit PoolStore(const std::filesystem::path& state) : layout{state} {}

  Layout layout;
  std::unique_ptr<Database> database = open_store(layout.database()).value();
  JobChanges changes{*database, {}, system_clock_ms};
  JobStore jobs{changes, layout, {}};
  JobQueue queue{changes};
  JobRetention retention{changes, layout};
};

}  // namespace hydroprint::daemon
