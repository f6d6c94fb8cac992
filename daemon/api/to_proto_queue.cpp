#include "daemon/api/to_proto_queue.h"

#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kMostQueuedShown = 1000;

}  // namespace

Result<v1::Queue> queue_message(const ServiceContext& backend) {
  HP_ASSIGN_OR_RETURN(const QueuePause pause, backend.queue.pause());
  HP_ASSIGN_OR_RETURN(const auto order, backend.pool.order(kMostQueuedShown));
  HP_ASSIGN_OR_RETURN(const auto queued, backend.jobs.ids_in_state(JobState::kQueued));
  v1::Queue queue;
  queue.set_paused(pause.paused);
  queue.set_pause_reason(pause.reason);
  queue.set_blocked_reason(backend.pool.blocked_reason());
  queue.set_confinement_warning(backend.pool.options().confinement_warning);
  for (const std::int64_t id : order) queue.add_queued_jobs(job_name(id));
  queue.set_queued_count(static_cast<std::int32_t>(queued.size()));
  HP_ASSIGN_OR_RETURN(const auto computing, backend.queue.computing());
  for (const std::int64_t id : computing) queue.add_running_jobs(job_name(id));
  queue.set_worker_slots(backend.pool.slots());
  queue.set_daemon_version(HYDROPRINT_VERSION);
  return queue;
}

}  // namespace hydroprint::daemon
