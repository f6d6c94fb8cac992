#include "daemon/auth/audit_log.h"

#include <fmt/format.h>

#include <utility>

#include "daemon/store/database/retention_clock.h"

namespace hydroprint::auth {
namespace {

constexpr std::size_t kMostWaiting = 10000;
constexpr std::int64_t kYear_ms = 365LL * 24 * 3600 * 1000;
constexpr std::int64_t kMostEntries = 1'000'000;

Status insert_entry(daemon::Database& database, const AuditEntry& entry) {
  return database.run(
      "INSERT INTO audit(time_ms, who, via, peer, what, object, outcome, detail) VALUES "
      "(?,?,?,?,?,?,?,?)",
      {entry.time_ms, entry.who, entry.via, entry.peer, entry.what, entry.object, entry.outcome,
       entry.detail});
}

AuditEntry read_entry(const daemon::DbRow& row) {
  return {row.integer(0), row.integer(1), row.text(2), row.text(3), row.text(4),
          row.text(5),    row.text(6),    row.text(7), row.text(8)};
}

AuditEntry told_of_loss(std::int64_t count, std::int64_t time_ms) {
  AuditEntry entry;
  entry.time_ms = time_ms;
  entry.what = "AuditLog";
  entry.outcome = "DATA_LOSS";
  entry.detail = fmt::format("{} entries could not be written", count);
  return entry;
}

}  // namespace

AuditLog::AuditLog(daemon::Database& database, daemon::Clock clock)
    : database_(database), clock_(std::move(clock)), thread_([this] { work(); }) {}

AuditLog::~AuditLog() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  some_.notify_one();
  thread_.join();
}

std::uint64_t AuditLog::note(AuditEntry entry) {
  entry.time_ms = clock_();
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMostWaiting) {
      ++lost_;
      return 0;
    }
    waiting_.push_back(std::move(entry));
    number = ++noted_;
  }
  some_.notify_one();
  return number;
}

bool AuditLog::wait_written(std::uint64_t noted, std::chrono::milliseconds limit) {
  std::unique_lock lock(mutex_);
  settled_.wait_for(lock, limit, [&] { return written_ >= noted || failed_ >= noted; });
  return noted != 0 && written_ >= noted && failed_ < noted;
}

void AuditLog::work() {
  for (bool last = false; !last;) {
    {
      std::unique_lock lock(mutex_);
      some_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
      last = ending_;
    }
    (void)write_waiting();  // failures are counted, and reported once writing works again
  }
}

Status AuditLog::write_waiting() {
  const std::lock_guard writing(writing_);
  std::vector<AuditEntry> entries;
  std::int64_t lost = 0;
  std::uint64_t last = 0;
  {
    const std::lock_guard lock(mutex_);
    last = noted_;
    entries = std::exchange(waiting_, {});
    lost = std::exchange(lost_, 0);
  }
  if (entries.empty() && lost == 0) return {};
  const Status written = database_.transaction([&]() -> Status {
    if (lost > 0) HP_RETURN_IF_ERROR(insert_entry(database_, told_of_loss(lost, clock_())));
    for (const AuditEntry& entry : entries) HP_RETURN_IF_ERROR(insert_entry(database_, entry));
    return {};
  });
  {
    const std::lock_guard lock(mutex_);
    (written ? written_ : failed_) = last;
    if (!written) lost_ += lost + static_cast<std::int64_t>(entries.size());
  }
  settled_.notify_all();
  return written;
}

Result<std::vector<AuditEntry>> AuditLog::list(const AuditFilter& filter) {
  HP_RETURN_IF_ERROR(write_waiting());
  std::vector<AuditEntry> entries;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT seq, time_ms, who, via, peer, what, object, outcome, detail FROM audit WHERE "
      "(?1='' OR who=?1) AND substr(what, 1, length(?2))=?2 AND (?3=0 OR seq<?3) ORDER BY seq DESC "
      "LIMIT ?4",
      {filter.who, filter.what, filter.before, filter.limit},
      [&](const daemon::DbRow& row) { entries.push_back(read_entry(row)); }));
  return entries;
}

Status AuditLog::clean_up() {
  HP_ASSIGN_OR_RETURN(const std::int64_t now_ms, daemon::credible_time_ms(database_, clock_()));
  HP_RETURN_IF_ERROR(database_.run("DELETE FROM audit WHERE time_ms<?", {now_ms - kYear_ms}));
  return database_.run("DELETE FROM audit WHERE seq<=(SELECT max(seq) FROM audit)-?",
                       {kMostEntries});
}

}  // namespace hydroprint::auth
