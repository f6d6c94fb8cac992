#include "client/cli/rig_session/held_lease.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "client/cli/rig_session/lease_file.h"
#include "client/cli/terminal/console.h"
#include "client/time.h"

namespace hydroprint::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kLookEvery = 30s;
constexpr auto kRenewBefore = 5min;

std::string at(const std::map<std::string, std::string>& metadata, const char* key) {
  const auto found = metadata.find(key);
  return found == metadata.end() ? "" : found->second;
}

// Returns "alice holds it for 'calibration' until 2026-03-01T14:05:09Z"; empty if no holder is
// given.
std::string holder_of(const Error& error) {
  const std::string holder = at(error.metadata, "holder");
  if (holder.empty()) return "";
  const std::string purpose = at(error.metadata, "purpose");
  return fmt::format("{} holds it{} until {}", holder,
                     purpose.empty() ? "" : fmt::format(" for '{}'", purpose),
                     at(error.metadata, "expire_time"));
}

std::map<std::string, std::string> metadata_of(const v1::Lease& lease) {
  return {{"holder", lease.holder()},
          {"purpose", lease.purpose()},
          {"expire_time", google::protobuf::util::TimeUtil::ToString(lease.expire_time())}};
}

// Returns the remaining time of a lease, at least kLeaseTime, because a renewal must not shorten
// the lease.
std::chrono::seconds time_to_renew_to(const v1::Lease& lease) {
  const auto end = client::time_of(lease.expire_time());
  if (!end) return kLeaseTime;
  using namespace std::chrono;
  return std::max<seconds>(kLeaseTime, ceil<seconds>(*end - system_clock::now()));
}

Error none_is_kept(Program& program) {
  Error error{Code::kFailedPrecondition, "", ErrorReason::LEASE_REQUIRED};
  if (const auto lease = client::get_lease(program.daemon())) error.metadata = metadata_of(*lease);
  return error;
}

}  // namespace

HeldLease::HeldLease(const Program& program, std::string id, bool is_given_back)
    : server_(program.server()),
      daemon_(program.options({})),
      id_(std::move(id)),
      is_given_back_(is_given_back),
      renewer_([this](const std::stop_token& stop) { renew_until(stop); }) {}

HeldLease::~HeldLease() {
  renewer_.request_stop();
  renewer_.join();
  if (!is_given_back_) return;
  // If this fails, the lease expires by itself.
  static_cast<void>(client::release_lease(daemon_, id_));
  forget_lease(server_, id_);
}

Result<std::unique_ptr<HeldLease>> HeldLease::acquire(Program& program,
                                                      const std::string& purpose) {
  HP_ASSIGN_OR_RETURN(const v1::Lease lease,
                      client::acquire_lease(program.daemon(), purpose, kLeaseTime));
  return std::unique_ptr<HeldLease>(new HeldLease(program, lease.lease_id(), true));
}

Result<std::unique_ptr<HeldLease>> HeldLease::take(Program& program, const std::string& purpose) {
  static_cast<void>(program.daemon());  // starts Ctrl-C handling before other threads exist
  if (!purpose.empty()) return acquire(program, purpose);
  const auto kept = kept_lease(program.server());
  if (!kept) return tl::unexpected(none_is_kept(program));
  return std::unique_ptr<HeldLease>(new HeldLease(program, *kept, false));
}

Result<std::unique_ptr<HeldLease>> HeldLease::take_or_acquire(Program& program,
                                                              const std::string& purpose) {
  const auto kept = kept_lease(program.server());
  const auto current = client::get_lease(program.daemon());
  if (kept && current && client::renew_lease(program.daemon(), *kept, time_to_renew_to(*current)))
    return std::unique_ptr<HeldLease>(new HeldLease(program, *kept, false));
  HP_ASSIGN_OR_RETURN(auto lease, acquire(program, purpose));
  HP_RETURN_IF_ERROR(keep_lease(program.server(), lease->id()));
  return lease;
}

void HeldLease::renew_until(const std::stop_token& stop) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any condition;
  // A failed renewal is not reported here: the next command will fail and report it.
  while (!condition.wait_for(lock, stop, kLookEvery, [] { return false; }) &&
         !stop.stop_requested()) {
    const auto lease = client::get_lease(daemon_);
    const auto end = lease ? client::time_of(lease->expire_time()) : std::nullopt;
    if (end && *end - std::chrono::system_clock::now() < kRenewBefore)
      static_cast<void>(client::renew_lease(daemon_, id_, kLeaseTime));
  }
}

void add_lease_flag(CLI::App& command, std::string& purpose) {
  command
      .add_option("--with-lease", purpose,
                  "Acquire the lease for this command only, with this purpose; default: use the\n"
                  "lease from 'hydroprint rig lease acquire'")
      ->type_name("PURPOSE");
}

Error in_our_words(Error error) {
  const std::string who = holder_of(error);
  if (error.reason == ErrorReason::LEASE_HELD)
    error.message = fmt::format(
        "the rig's lease is taken{}{}; ask the holder, or end the lease with 'hydroprint rig lease "
        "break --reason ...'",
        who.empty() ? "" : ": ", who);
  if (error.reason == ErrorReason::LEASE_REQUIRED)
    error.message =
        fmt::format("commanding the rig needs its lease, which you do not hold{}",
                    who.empty() ? "; acquire it with 'hydroprint rig lease acquire --purpose ...'"
                                : fmt::format(": {}; ask the holder, or end the lease with "
                                              "'hydroprint rig lease break --reason ...'",
                                              who));
  return error;
}

}  // namespace hydroprint::cli
