#include "daemon/store/job_retention.h"

#include <cstdlib>
#include <set>

#include "daemon/platform/durable_file.h"
#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/database/retention_clock.h"
#include "daemon/store/idempotency.h"
#include "daemon/store/job_rows.h"
#include "daemon/store/set_aside.h"

namespace hydroprint::daemon {
namespace {

// SQL condition for deleting a job: its retention time is over, and it is not kept for another
// reason.
constexpr const char* kIsDue =
    "purge_ms>0 AND purge_ms<=?1 AND pinned=0 AND NOT EXISTS (SELECT 1 FROM calibrations WHERE "
    "calibrations.job=jobs.id)";

constexpr std::int64_t kWorthLogging_ms = 60 * 1000;

void log_jump(std::int64_t jump_ms) {
  if (std::abs(jump_ms) < kWorthLogging_ms) return;
  log(LogLevel::kWarning, "clock_jumped",
      {{"by_s", jump_ms / 1000},
       {"message",
        "the daemon was off for more than a day, or the clock was set; all retention "
        "times were shifted by that time (by_s)"}});
}

}  // namespace

Result<Job> JobRetention::pin(std::int64_t id, bool pinned) {
  return changes_.change(id, [&](const Job& job) -> Status {
    if (job.pinned == pinned) return {};
    const std::int64_t now = changes_.now_ms();
    HP_RETURN_IF_ERROR(
        database_.run("UPDATE jobs SET pinned=?, update_ms=?, version=version+1 WHERE id=?",
                      {std::int64_t{pinned}, now, id}));
    if (pinned || !is_finished(job.state)) return {};
    HP_RETURN_IF_ERROR(database_.run("UPDATE jobs SET keep_from_ms=? WHERE id=?", {now, id}));
    return changes_.set_purge_time("id=?", id);
  });
}

// Deletes one job, unless it has just been pinned.
Status JobRetention::purge_one(std::int64_t id) {
  bool is_gone = false;
  std::string owner, name;
  const Status done = database_.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const Job job, select_job(database_, id));
    if (!is_finished(job.state)) return {};
    HP_RETURN_IF_ERROR(database_.run(std::string("DELETE FROM jobs WHERE ") + kIsDue + " AND id=?2",
                                     {changes_.now_ms(), id}));
    is_gone = database_.changes() > 0;
    owner = job.definition.owner;
    name = job.definition.display_name;
    return {};
  });
  HP_RETURN_IF_ERROR(done);
  if (!is_gone) return {};
  discard(layout_.artifacts(id));
  log(LogLevel::kInfo, "job_deleted",
      {{"job", id}, {"owner", owner}, {"name", name}, {"why", "its retention time is over"}});
  changes_.notifier().ring();
  return {};
}

Status JobRetention::purge() {
  HP_ASSIGN_OR_RETURN(const std::int64_t jump_ms, follow_clock(database_, changes_.now_ms()));
  log_jump(jump_ms);
  HP_ASSIGN_OR_RETURN(
      const auto readers,
      select_numbers(database_,
                     "SELECT 1 FROM jobs WHERE state IN (2,3,4) AND reads_artifacts=1 LIMIT 1",
                     {}));
  HP_ASSIGN_OR_RETURN(const auto old, select_numbers(database_,
                                                     std::string("SELECT id FROM jobs WHERE ") +
                                                         kIsDue + " ORDER BY purge_ms, id",
                                                     {changes_.now_ms()}));
  for (const std::int64_t id : old) {
    if (readers.empty()) HP_RETURN_IF_ERROR(purge_one(id));
  }
  return forget_old_requests(database_, changes_.now_ms());
}

Status JobRetention::empty_runs(const std::vector<Execution>& kept) {
  std::set<std::filesystem::path> in_use;
  for (const Execution& execution : kept) in_use.insert(execution.folder);
  std::vector<std::filesystem::path> unused;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(layout_.runs(), ignored)) {
    if (!in_use.contains(entry.path())) unused.push_back(entry.path());
  }
  for (const auto& path : unused) discard(path);
  return make_folder(layout_.runs());
}

Status JobRetention::sweep(const std::vector<Execution>& kept) {
  HP_RETURN_IF_ERROR(empty_runs(kept));
  HP_RETURN_IF_ERROR(make_folder(layout_.artifacts()));
  HP_RETURN_IF_ERROR(changes_.set_purge_time("end_ms>?", 0));
  HP_ASSIGN_OR_RETURN(const auto done,
                      select_numbers(database_, "SELECT DISTINCT job FROM artifacts", {}));
  std::set<std::int64_t> owned(done.begin(), done.end());
  // The previous daemon may have been killed while it published them; WorkerRun continues.
  for (const Execution& execution : kept) owned.insert(execution.job);
  SetAside set_aside(layout_, changes_.now_ms());
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(layout_.artifacts(), ignored)) {
    if (owned.contains(parse_number(entry.path().filename().string()))) continue;
    HP_RETURN_IF_ERROR(set_aside.move(entry.path()));
  }
  return {};
}

}  // namespace hydroprint::daemon
