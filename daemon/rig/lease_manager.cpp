#include "daemon/rig/lease_manager.h"

#include <fmt/format.h>

#include <utility>

#include "daemon/platform/resource_names.h"
#include "daemon/store/idempotency.h"
#include "daemon/store/to_proto.h"

namespace hydroprint::daemon {
namespace {

void describe(const Lease& lease, Error& error) {
  error.metadata["holder"] = lease.holder;
  error.metadata["purpose"] = lease.purpose;
  error.metadata["expire_time"] = time_text(lease.expire_ms);
}

tl::unexpected<Error> is_held(const Lease& lease) {
  Error error{
      Code::kAborted,
      fmt::format(
          "{} holds the rig's lease until {} ({}); ask them to release it, or break the lease",
          lease.holder, time_text(lease.expire_ms), lease.purpose),
      ErrorReason::LEASE_HELD,
      {}};
  describe(lease, error);
  return tl::unexpected(std::move(error));
}

tl::unexpected<Error> is_required(const std::optional<Lease>& held) {
  Error error{Code::kFailedPrecondition,
              "commands to the rig require its lease; acquire the lease first",
              ErrorReason::LEASE_REQUIRED,
              {}};
  if (held) {
    error.message += fmt::format("; currently {} holds the lease until {} ({})", held->holder,
                                 time_text(held->expire_ms), held->purpose);
    describe(*held, error);
  }
  return tl::unexpected(std::move(error));
}

}  // namespace

LeaseManager::LeaseManager(Database& database, Clock clock)
    : database_(database), clock_(std::move(clock)) {}

Status LeaseManager::load() {
  std::optional<Lease> found;
  HP_RETURN_IF_ERROR(database_.each(
      "SELECT id, holder, purpose, acquire_ms, expire_ms FROM lease", {}, [&](const DbRow& row) {
        found = {row.text(0), row.text(1), row.text(2), row.integer(3), row.integer(4)};
      }));
  set(std::move(found));
  return {};
}

std::optional<Lease> LeaseManager::held() const {
  return lease_ && lease_->expire_ms > clock_() ? lease_ : std::nullopt;
}

std::optional<Lease> LeaseManager::current() const {
  const std::lock_guard lock(now_);
  return held();
}

void LeaseManager::set(std::optional<Lease> lease) {
  const std::lock_guard lock(now_);
  lease_ = std::move(lease);
}

Result<Lease> LeaseManager::required(const std::string& id) const {
  const auto lease = held();
  if (!lease || id.empty() || lease->id != id) return is_required(lease);
  return *lease;
}

Result<Lease> LeaseManager::require(const std::string& id) const {
  const std::lock_guard lock(now_);
  return required(id);
}

Status LeaseManager::write(const Lease& lease) {
  return database_.run(
      "INSERT OR REPLACE INTO lease(one, id, holder, purpose, acquire_ms, expire_ms) "
      "VALUES (1,?,?,?,?,?)",
      {lease.id, lease.holder, lease.purpose, lease.acquire_ms, lease.expire_ms});
}

Result<Lease> LeaseManager::acquire(const std::string& holder, const std::string& purpose,
                                    std::int64_t ttl_ms, const RequestKey& request) {
  const std::lock_guard writing(writing_);
  Lease lease;
  const Status done = database_.transaction([&]() -> Status {
    const std::int64_t now_ms = clock_();
    HP_ASSIGN_OR_RETURN(const auto earlier, earlier_result(database_, holder, request, now_ms));
    if (earlier) {
      HP_ASSIGN_OR_RETURN(lease, require(*earlier));
      return {};
    }
    if (const auto other = current()) return is_held(*other);
    lease = {make_token(), holder, purpose, now_ms, now_ms + ttl_ms};
    HP_RETURN_IF_ERROR(write(lease));
    return remember_result(database_, holder, request, lease.id, now_ms);
  });
  HP_RETURN_IF_ERROR(done);
  set(lease);
  return lease;
}

Result<Lease> LeaseManager::renew(const std::string& id, std::int64_t ttl_ms) {
  const std::lock_guard writing(writing_);
  HP_ASSIGN_OR_RETURN(Lease lease, require(id));
  lease.expire_ms = clock_() + ttl_ms;
  HP_RETURN_IF_ERROR(write(lease));
  set(lease);
  return lease;
}

Result<std::optional<Lease>> LeaseManager::end(const std::optional<Lease>& ended) {
  if (!ended) return ended;
  HP_RETURN_IF_ERROR(database_.run("DELETE FROM lease"));
  set(std::nullopt);
  return ended;
}

Result<std::optional<Lease>> LeaseManager::release(const std::string& id) {
  const std::lock_guard writing(writing_);
  const auto lease = require(id);
  return end(lease ? std::optional(*lease) : std::nullopt);
}

Result<std::optional<Lease>> LeaseManager::take_away() {
  const std::lock_guard writing(writing_);
  return end(current());
}

std::optional<Lease> LeaseManager::take_expired() {
  const std::lock_guard lock(now_);
  if (!lease_ || held()) return std::nullopt;
  return std::exchange(lease_, std::nullopt);
}

}  // namespace hydroprint::daemon
