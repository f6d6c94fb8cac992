#include "daemon/rig/rig_reference.h"

#include <string>
#include <utility>

#include "daemon/platform/log.h"
#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {
namespace {

constexpr const char* kHomings = "rig_homings";
constexpr const char* kDips = "rig_dips";

Result<std::int64_t> count(Database& database, const char* name) {
  HP_ASSIGN_OR_RETURN(
      const auto found,
      select_numbers(database, "SELECT CAST(value AS INTEGER) FROM settings WHERE name=?", {name}));
  return found.empty() ? 0 : found.front();
}

}  // namespace

Status RigReference::load() {
  const std::lock_guard lock(mutex_);
  HP_ASSIGN_OR_RETURN(homings_, count(database_, kHomings));
  HP_ASSIGN_OR_RETURN(dips_, count(database_, kDips));
  return {};
}

RigPlace RigReference::place() {
  if (controller_ == nullptr) return {};
  const std::lock_guard lock(mutex_);
  const rig::Snapshot now = controller_->snapshot();
  const bool was_homed = std::exchange(homed_, now.condition.homed);
  if (homed_ && !was_homed) ++homings_;
  return {true, homed_, homed_ ? now.position_mm : 0, homings_, dips_};
}

Status RigReference::keep() {
  std::unique_lock lock(mutex_);
  const std::string homings = std::to_string(homings_), dips = std::to_string(dips_);
  lock.unlock();
  return database_.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(
        database_.run("INSERT OR REPLACE INTO settings VALUES (?,?)", {kHomings, homings}));
    return database_.run("INSERT OR REPLACE INTO settings VALUES (?,?)", {kDips, dips});
  });
}

void RigReference::note_dip() {
  {
    const std::lock_guard lock(mutex_);
    ++dips_;
  }
  const Status kept = keep();
  if (!kept) log(LogLevel::kError, "place_not_stored", {{"message", kept.error().message}});
}

}  // namespace hydroprint::daemon
