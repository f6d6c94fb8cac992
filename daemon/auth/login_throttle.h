#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>

#include "daemon/platform/clock.h"

namespace hydroprint::auth {

/// Limits sign-in attempts. After a few failures each further attempt has to wait 1 s, 2 s, 4 s and
/// so on. The longest wait is 1 min for a combination of name and address, 30 s for an address, and
/// 10 s for a name from any address. No user is locked out: if a name has signed in from an address
/// before, only failures with this name from this address delay a further attempt. An hour without
/// attempts resets all counters. Uses bounded memory. Thread-safe.
class LoginThrottle {
 public:
  explicit LoginThrottle(daemon::Clock clock) : clock_(std::move(clock)) {}

  /// Starts an attempt. Returns 0 if it may proceed; it then counts as failed until succeeded() is
  /// called. Otherwise returns the time to wait in ms, and does not count the attempt.
  [[nodiscard]] std::int64_t begin(const std::string& name, const std::string& peer);
  void succeeded(const std::string& name, const std::string& peer);
  /// Counts a failed attempt without a name: one with a sign-in link.
  void reject();
  /// Returns the number of failures since the daemon started.
  [[nodiscard]] std::int64_t failures() const;

 private:
  struct Limit {
    int free = 0;              ///< number of failures before waits begin
    std::int64_t most_ms = 0;  ///< longest wait
  };
  struct Failures {
    int count = 0;
    std::int64_t last_ms = 0;
  };
  using Pair = std::pair<std::string, std::string>;  // name, peer; one of them may be empty

  [[nodiscard]] std::int64_t wait_ms(const Pair& key, std::int64_t now_ms) const;
  [[nodiscard]] static Limit limit_of(const Pair& key);
  void count(const Pair& key, std::int64_t now_ms);
  void forget_some(std::int64_t now_ms);

  daemon::Clock clock_;
  mutable std::mutex mutex_;
  std::map<Pair, Failures> failures_;
  std::set<Pair> good_;  // pairs that have signed in
  std::int64_t failed_ = 0;
};

}  // namespace hydroprint::auth
