#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "daemon/api/service_context.h"
#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// One message of a watch: the sequence number to resume after, and optionally the job and an
/// event.
struct WatchItem {
  std::int64_t seq = 0;
  std::optional<Job> job;
  std::optional<JobEvent> event;
};

/// Follows one job until it is finished and all messages are sent: see JobService.WatchJob. Blocks
/// the calling thread.
/// @param send  returns false if the client has disconnected
/// @param gone  returns whether the client has disconnected; called several times a second
[[nodiscard]] Status watch_job(const ServiceContext& backend, std::int64_t id,
                               std::optional<std::int64_t> after_seq,
                               const std::function<bool(const WatchItem&)>& send,
                               const std::function<bool()>& gone);

}  // namespace hydroprint::daemon
