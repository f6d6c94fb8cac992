#include "daemon/api/job_watch.h"

namespace hydroprint::daemon {
namespace {

constexpr int kBatch = 100;
constexpr std::chrono::milliseconds kPollInterval{250};

tl::unexpected<Error> client_gone() { return fail(Code::kCancelled, "the client disconnected"); }

// Sends the events after `seq` and advances `seq`. Returns whether there were any events.
Result<bool> send_events(const ServiceContext& backend, std::int64_t id, std::int64_t& seq,
                         const std::function<bool(const WatchItem&)>& send) {
  HP_ASSIGN_OR_RETURN(const auto events, backend.jobs.events(id, seq, kBatch));
  for (const JobEvent& event : events) {
    WatchItem item{event.seq, {}, event};
    if (event.kind == EventKind::kStateChanged) {
      HP_ASSIGN_OR_RETURN(item.job, backend.jobs.get(id));
    }
    if (!send(item)) return client_gone();
    seq = event.seq;
  }
  return !events.empty();
}

}  // namespace

Status watch_job(const ServiceContext& backend, std::int64_t id,
                 std::optional<std::int64_t> after_seq,
                 const std::function<bool(const WatchItem&)>& send,
                 const std::function<bool()>& gone) {
  // Reads the sequence number before the job, so that an event between these two reads is sent
  // again rather than lost.
  HP_ASSIGN_OR_RETURN(std::int64_t seq, backend.jobs.last_seq());
  if (after_seq) {
    HP_RETURN_IF_ERROR(backend.jobs.events(id, *after_seq, 1));
    seq = *after_seq;
  }
  HP_ASSIGN_OR_RETURN(const Job first, backend.jobs.get(id));
  if (!send({seq, first, {}})) return client_gone();
  for (;;) {
    const std::uint64_t version = backend.jobs.notifier().count();
    // Reads the state before the events, so that no event is missed after the end of a job.
    HP_ASSIGN_OR_RETURN(const Job job, backend.jobs.get(id));
    HP_ASSIGN_OR_RETURN(const bool sent, send_events(backend, id, seq, send));
    if (sent) continue;
    if (is_finished(job.state)) return {};
    HP_RETURN_IF_ERROR(check_serving(backend));
    if (gone()) return client_gone();
    backend.jobs.notifier().wait(version, kPollInterval);
  }
}

}  // namespace hydroprint::daemon
