#include "daemon/store/interruption.h"

#include <fmt/format.h>

#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {
namespace {

constexpr std::int64_t kMostLosses = 3;

const char* words_of(Interruption why) {
  switch (why) {
    case Interruption::kShutdown:
      return "the daemon was shut down";
    case Interruption::kLoss:
      return "the daemon was restarted";
    case Interruption::kWorkerLoss:
      return "the worker was lost";
  }
  return "";
}

Error lost_too_often(Interruption why) {
  if (why == Interruption::kWorkerLoss) {
    return {Code::kInternal,
            fmt::format("the worker of this job was lost {} times, so it was not started again; "
                        "check the machines that run workers, and retry the job if the job was not "
                        "the cause",
                        kMostLosses),
            ErrorReason::WORKER_KILLED,
            {}};
  }
  return {Code::kInternal,
          fmt::format(
              "the daemon was killed, or its machine crashed, {} times while this job ran, so "
              "it was not started again; check the daemon's log, and retry the job if the job was "
              "not the cause",
              kMostLosses),
          ErrorReason::DAEMON_LOST,
          {}};
}

// A job that crashes the machine must not do so at every start.
Status queue_again(JobChanges& changes, std::int64_t id, Interruption why) {
  Database& database = changes.database();
  if (why != Interruption::kShutdown) {
    HP_RETURN_IF_ERROR(
        database.run("INSERT INTO losses VALUES (?,1) ON CONFLICT(job) DO UPDATE SET "
                     "count=count+1",
                     {id}));
    HP_ASSIGN_OR_RETURN(const auto losses,
                        select_numbers(database, "SELECT count FROM losses WHERE job=?", {id}));
    if (losses.front() >= kMostLosses) {
      return changes.finish_failed(id, {lost_too_often(why), {}, {}});
    }
  }
  HP_RETURN_IF_ERROR(close_execution(database, id));
  return changes.set_state(id, JobState::kQueued, "queued again");
}

}  // namespace

Status interrupt_open(JobChanges& changes, const Job& job, Interruption why) {
  const std::string words = words_of(why);
  if (job.state == JobState::kCancelling) {
    return changes.finish(job.id, JobState::kCancelled, words);
  }
  if (!job.definition.traits.computed) {
    const std::string& advice = job.definition.traits.interrupted_advice;
    return changes.finish(job.id, JobState::kInterrupted,
                          advice.empty() ? words : words + ": " + advice);
  }
  HP_RETURN_IF_ERROR(changes.set_state(job.id, JobState::kInterrupted, words));
  return queue_again(changes, job.id, why);
}

}  // namespace hydroprint::daemon
