#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "daemon/api/service_context.h"
#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// One message of a watch: the number to resume after, the job where it is to be shown, the event
/// where there is one.
struct WatchItem {
  std::int64_t seq = 0;
  std::optional<Job> job;
  std::optional<JobEvent> event;
};

/// Follows one job until it is finished and everything was sent: see JobService.WatchJob. Waits in
/// the calling thread.
/// @param send  false: the client is gone
/// @param gone  asked a few times a second
[[nodiscard]] Status watch_job(const ServiceContext& backend, std::int64_t id,
                               std::optional<std::int64_t> after_seq,
                               const std::function<bool(const WatchItem&)>& send,
                               const std::function<bool()>& gone);

}  // namespace hydroprint::daemon
