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

/// The lease under which a command drives the rig: kept by `rig lease acquire`, or taken for this
/// command alone. For as long as this lives it is renewed before it runs out.
class HeldLease {
 public:
  /// With a purpose: acquires one, and gives it back in the end. Without: the one kept.
  /// @return kFailedPrecondition (LEASE_REQUIRED) if none is kept, saying who has it and what to do
  [[nodiscard]] static Result<std::unique_ptr<HeldLease>> take(Program& program,
                                                               const std::string& purpose);
  /// The one kept if it still holds; otherwise acquires one, keeps it for other commands, and gives
  /// it back in the end.
  [[nodiscard]] static Result<std::unique_ptr<HeldLease>> take_or_acquire(
      Program& program, const std::string& purpose);
  ~HeldLease();
  HeldLease(const HeldLease&) = delete;
  HeldLease& operator=(const HeldLease&) = delete;

  [[nodiscard]] const std::string& id() const { return id_; }
  /// It is not given back in the end.
  void leave() { is_given_back_ = false; }

 private:
  HeldLease(const Program& program, std::string id, bool is_given_back);
  [[nodiscard]] static Result<std::unique_ptr<HeldLease>> acquire(Program& program,
                                                                  const std::string& purpose);
  void renew_until(const std::stop_token& stop);

  std::string server_;
  client::Connection daemon_;  // goes on when Ctrl-C ends the command's
  std::string id_;
  bool is_given_back_;
  std::jthread renewer_;  // the last: it uses all the others
};

/// How long a lease is taken for where nobody says how long, and renewed to.
inline constexpr std::chrono::minutes kLeaseTime{10};

/// Adds --with-lease PURPOSE.
void add_lease_flag(CLI::App& command, std::string& purpose);

/// An error as it is, but those about the lease in our words: who has it, what for, until when, and
/// which command helps.
[[nodiscard]] Error in_our_words(Error error);

}  // namespace hydroprint::cli
