#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "client/cli/program/program.h"
#include "client/lease.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// The lease under which a command moves the rig: stored by `rig lease acquire`, or acquired for
/// this command only. It is renewed during the lifetime of this object.
class HeldLease {
 public:
  /// With a purpose: acquires a lease and releases it at the end. Without: uses the stored lease.
  /// @return kFailedPrecondition (LEASE_REQUIRED) if none is stored; in_our_words() adds the holder
  ///         and the remedy
  [[nodiscard]] static Result<std::unique_ptr<HeldLease>> take(Program& program,
                                                               const std::string& purpose);
  /// Uses the stored lease if it is still valid. Otherwise acquires one, stores it for other
  /// commands, and releases it at the end.
  [[nodiscard]] static Result<std::unique_ptr<HeldLease>> take_or_acquire(
      Program& program, const std::string& purpose);
  ~HeldLease();
  HeldLease(const HeldLease&) = delete;
  HeldLease& operator=(const HeldLease&) = delete;

  [[nodiscard]] const std::string& id() const { return id_; }
  /// Keeps the lease at the end instead of releasing it.
  void leave() { is_given_back_ = false; }

 private:
  HeldLease(const Program& program, std::string id, bool is_given_back);
  [[nodiscard]] static Result<std::unique_ptr<HeldLease>> acquire(Program& program,
                                                                  const std::string& purpose);
  void renew_until(const std::stop_token& stop);

  std::string server_;
  client::Connection daemon_;  // not affected by Ctrl-C
  std::string id_;
  bool is_given_back_;
  std::jthread renewer_;  // last member, because it uses the others
};

/// Default duration of a lease, also for renewals.
inline constexpr std::chrono::minutes kLeaseTime{10};

/// Adds --with-lease PURPOSE.
void add_lease_flag(CLI::App& command, std::string& purpose);

/// Extends errors about the lease with holder, purpose, expiry, and the command that helps. Other
/// errors are returned unchanged.
[[nodiscard]] Error in_our_words(Error error);

}  // namespace hydroprint::cli
