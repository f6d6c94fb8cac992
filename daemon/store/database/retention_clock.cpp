#include "daemon/store/database/retention_clock.h"

#include <algorithm>
#include <optional>
#include <string>

namespace hydroprint::daemon {
namespace {

constexpr std::int64_t kDay_ms = 24LL * 3600 * 1000;
constexpr const char* kSeen = "retention_seen_ms";
constexpr const char* kJumps = "retention_jumps_ms";

Result<std::optional<std::int64_t>> read(Database& database, const char* name) {
  std::optional<std::int64_t> value;
  HP_RETURN_IF_ERROR(database.each("SELECT CAST(value AS INTEGER) FROM settings WHERE name=?",
                                   {name}, [&](const DbRow& row) { value = row.integer(0); }));
  return value;
}

Status write(Database& database, const char* name, std::int64_t value) {
  return database.run("INSERT OR REPLACE INTO settings VALUES (?,?)",
                      {name, std::to_string(value)});
}

/// Returns the jump in a step of the clock; 0 if the step is plausible as elapsed time.
std::int64_t jump_in(std::int64_t step_ms) {
  return step_ms < 0 || step_ms > kDay_ms ? step_ms : 0;
}

Status move_deadlines(Database& database, std::int64_t by_ms) {
  HP_RETURN_IF_ERROR(
      database.run("UPDATE jobs SET keep_from_ms=keep_from_ms+? WHERE keep_from_ms>0", {by_ms}));
  HP_RETURN_IF_ERROR(
      database.run("UPDATE jobs SET purge_ms=max(1, purge_ms+?) WHERE purge_ms>0", {by_ms}));
  HP_RETURN_IF_ERROR(database.run("UPDATE assets SET use_ms=use_ms+?", {by_ms}));
  return database.run("UPDATE uploads SET expire_ms=expire_ms+?", {by_ms});
}

}  // namespace

Result<std::int64_t> follow_clock(Database& database, std::int64_t now_ms) {
  std::int64_t jump_ms = 0;
  const Status done = database.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const auto seen, read(database, kSeen));
    jump_ms = seen ? jump_in(now_ms - *seen) : 0;
    if (jump_ms != 0) {
      HP_ASSIGN_OR_RETURN(const auto before, read(database, kJumps));
      HP_RETURN_IF_ERROR(
          write(database, kJumps, std::max<std::int64_t>(0, before.value_or(0) + jump_ms)));
      HP_RETURN_IF_ERROR(move_deadlines(database, jump_ms));
    }
    return seen == now_ms ? Status() : write(database, kSeen, now_ms);
  });
  HP_RETURN_IF_ERROR(done);
  return jump_ms;
}

Result<std::int64_t> credible_time_ms(Database& database, std::int64_t now_ms) {
  HP_RETURN_IF_ERROR(follow_clock(database, now_ms));
  HP_ASSIGN_OR_RETURN(const auto jumps, read(database, kJumps));
  return now_ms - jumps.value_or(0);
}

}  // namespace hydroprint::daemon
