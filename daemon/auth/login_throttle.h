#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>

#include "daemon/platform/clock.h"

namespace hydroprint::auth {

/// How often somebody may try to sign in. After a few failures each further attempt has to wait,
/// for 1 s, 2 s, 4 s and so on: of one name from one address up to a minute, from one address up to
/// half a minute, of one name from anywhere up to 10 s. Nobody is locked out: where a name has
/// signed in before, from that address, only what failed there counts for it. An hour without an
/// attempt makes all good. Any thread may call; it is kept in memory, and little of it.
class LoginThrottle {
 public:
  explicit LoginThrottle(daemon::Clock clock) : clock_(std::move(clock)) {}

  /// Whether to go on: 0, and the attempt counts as failed until succeeded() is called; else the
  /// time to wait in ms, and nothing is counted.
  [[nodiscard]] std::int64_t begin(const std::string& name, const std::string& peer);
  void succeeded(const std::string& name, const std::string& peer);
  /// Counts one that failed and has no name.
  void reject();
  /// How many failed since the daemon began.
  [[nodiscard]] std::int64_t failures() const;

 private:
  struct Limit {
    int free = 0;              ///< so many failures cost nothing
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
  std::set<Pair> good_;  // from where a name has signed in
  std::int64_t failed_ = 0;
};

}  // namespace hydroprint::auth
