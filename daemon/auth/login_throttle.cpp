#include "daemon/auth/login_throttle.h"

#include <algorithm>

namespace hydroprint::auth {
namespace {

constexpr std::int64_t kSecond_ms = 1000;
constexpr std::int64_t kMemory_ms = 3600 * kSecond_ms;
constexpr std::size_t kMaxEntries = 10000;
constexpr int kMostDoublings = 20;

}  // namespace

LoginThrottle::Limit LoginThrottle::limit_of(const Pair& key) {
  if (key.first.empty()) return {10, 30 * kSecond_ms};
  if (key.second.empty()) return {10, 10 * kSecond_ms};
  return {3, 60 * kSecond_ms};
}

std::int64_t LoginThrottle::wait_ms(const Pair& key, std::int64_t now_ms) const {
  const auto found = failures_.find(key);
  if (found == failures_.end() || now_ms - found->second.last_ms > kMemory_ms) return 0;
  const Limit limit = limit_of(key);
  const int beyond = found->second.count - limit.free;
  if (beyond < 0) return 0;
  const std::int64_t delay_ms =
      std::min(limit.most_ms, kSecond_ms << std::min(beyond, kMostDoublings));
  return std::max<std::int64_t>(0, found->second.last_ms + delay_ms - now_ms);
}

void LoginThrottle::count(const Pair& key, std::int64_t now_ms) {
  Failures& failures = failures_[key];
  if (now_ms - failures.last_ms > kMemory_ms) failures.count = 0;
  ++failures.count;
  failures.last_ms = now_ms;
}

std::int64_t LoginThrottle::begin(const std::string& name, const std::string& peer) {
  const std::lock_guard lock(mutex_);
  const std::int64_t now_ms = clock_();
  const Pair own{name, peer}, of_name{name, ""}, of_peer{"", peer};
  const bool is_known = good_.contains(own);
  std::int64_t wait = wait_ms(own, now_ms);
  if (!is_known) {
    wait = std::max({wait, wait_ms(of_name, now_ms), wait_ms(of_peer, now_ms)});
  }
  if (wait > 0) return wait;
  ++failed_;
  count(own, now_ms);
  if (!is_known) {
    count(of_name, now_ms);
    count(of_peer, now_ms);
  }
  forget_some(now_ms);
  return 0;
}

void LoginThrottle::succeeded(const std::string& name, const std::string& peer) {
  const std::lock_guard lock(mutex_);
  --failed_;
  failures_.erase({name, peer});
  // For the other pairs, undoes only the count of begin(): one correct password does not cancel
  // other failures.
  for (const Pair& key : {Pair{name, ""}, Pair{"", peer}}) {
    const auto found = failures_.find(key);
    if (found != failures_.end() && !good_.contains({name, peer})) --found->second.count;
  }
  if (good_.size() < kMaxEntries) good_.insert({name, peer});
}

void LoginThrottle::reject() {
  const std::lock_guard lock(mutex_);
  ++failed_;
}

std::int64_t LoginThrottle::failures() const {
  const std::lock_guard lock(mutex_);
  return failed_;
}

void LoginThrottle::forget_some(std::int64_t now_ms) {
  if (failures_.size() <= kMaxEntries) return;
  std::erase_if(failures_,
                [&](const auto& entry) { return now_ms - entry.second.last_ms > kMemory_ms; });
  while (failures_.size() > kMaxEntries) {
    failures_.erase(std::min_element(
        failures_.begin(), failures_.end(),
        [](const auto& a, const auto& b) { return a.second.last_ms < b.second.last_ms; }));
  }
}

}  // namespace hydroprint::auth
