#include "daemon/store/job_queue.h"

#include <algorithm>

#include "daemon/platform/resource_names.h"
#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {
namespace {

// Assigns the existing ranks and priorities to the jobs in their new order.
std::vector<WaitingJob> reordered(std::vector<WaitingJob> jobs, std::int64_t id,
                                  std::int64_t before) {
  std::vector<std::int64_t> ranks;
  ranks.reserve(jobs.size());
  for (const WaitingJob& job : jobs) ranks.push_back(job.rank);
  std::sort(ranks.begin(), ranks.end());
  const auto is = [](std::int64_t wanted) {
    return [wanted](const WaitingJob& job) { return job.id == wanted; };
  };
  const auto from = std::find_if(jobs.begin(), jobs.end(), is(id));
  WaitingJob moved = *from;
  jobs.erase(from);
  const auto place = std::find_if(jobs.begin(), jobs.end(), is(before));
  if (place != jobs.end()) moved.priority = place->priority;
  if (place == jobs.end() && !jobs.empty()) moved.priority = jobs.back().priority;
  jobs.insert(place, moved);
  for (std::size_t i = 0; i < jobs.size(); ++i) jobs[i].rank = ranks[i];
  return jobs;
}

tl::unexpected<Error> cannot_move(std::int64_t id, const std::string& why) {
  return fail(Code::kFailedPrecondition, job_name(id) + " " + why, ErrorReason::STATE_FORBIDS);
}

}  // namespace

Result<std::vector<WaitingJob>> JobQueue::waiting() {
  std::vector<WaitingJob> jobs;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT id, owner, priority, rank FROM jobs WHERE state=? ORDER BY priority DESC, rank",
      {number(JobState::kQueued)}, [&](const DbRow& row) {
        jobs.push_back({row.integer(0), row.text(1), static_cast<std::int32_t>(row.integer(2)),
                        row.integer(3)});
      }));
  return jobs;
}

Result<std::vector<std::int64_t>> JobQueue::computing() {
  return select_numbers(
      database_, "SELECT id FROM jobs WHERE state IN (?,?) AND computed=1 ORDER BY state, id",
      {number(JobState::kRunning), number(JobState::kCancelling)});
}

Result<Job> JobQueue::move(std::int64_t id, std::int64_t before) {
  return changes_.change(id, [&](const Job& job) -> Status {
    if (job.state != JobState::kQueued)
      return cannot_move(id, "is not queued, so it cannot be moved");
    HP_ASSIGN_OR_RETURN(std::vector<WaitingJob> all, waiting());
    std::erase_if(all,
                  [&](const WaitingJob& other) { return other.owner != job.definition.owner; });
    const bool there = std::any_of(all.begin(), all.end(),
                                   [&](const WaitingJob& other) { return other.id == before; });
    if (before != 0 && !there) {
      HP_RETURN_IF_ERROR(select_job(database_, before));
      return cannot_move(before, "is not a queued job of the same owner; name another job");
    }
    if (before == id) return {};
    for (const WaitingJob& place : reordered(all, id, before)) {
      HP_RETURN_IF_ERROR(
          database_.run("UPDATE jobs SET rank=?, priority=?, version=version+1 WHERE id=?",
                        {place.rank, std::int64_t{place.priority}, place.id}));
    }
    return changes_.add_event(id, EventKind::kMoved, "");
  });
}

Result<QueuePause> JobQueue::pause() {
  QueuePause pause;
  HP_RETURN_IF_ERROR(
      database_.each("SELECT value FROM settings WHERE name='pause'", {}, [&](const DbRow& row) {
        pause = {true, row.text(0)};
      }));
  return pause;
}

Status JobQueue::set_pause(const QueuePause& pause) {
  Status status =
      pause.paused
          ? database_.run("INSERT OR REPLACE INTO settings VALUES ('pause', ?)", {pause.reason})
          : database_.run("DELETE FROM settings WHERE name='pause'");
  changes_.notifier().ring();
  return status;
}

}  // namespace hydroprint::daemon
