#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <mutex>
#include <utility>
#include <vector>

#include "hardware/rig/motion_supervisor.h"

namespace hydroprint::rig {

/// What a command answers: the number of the motion that it started; 0 if it starts none.
using Answer = Result<std::uint64_t>;

/// One command on its way to the owner of the drive.
struct Order {
  Event::Kind kind = Event::Kind::kArm;
  Plan plan = {};
  TimePoint given = {};
  std::uint64_t stops = 0;  ///< how many stops had been asked for before it
  std::promise<Answer> answer = {};
};

/// Few commands, in order. Callers wait for each other, the owner for nobody.
class CommandQueue {
 public:
  /// False if it is full: then nothing was kept.
  [[nodiscard]] bool put(Order& order) {
    const std::lock_guard lock(mutex_);
    if (orders_.size() >= kMost) return false;
    orders_.push_back(std::move(order));
    return true;
  }
  /// All that wait; none if a caller is just putting one (it is there the next time).
  [[nodiscard]] std::deque<Order> take() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock ? std::exchange(orders_, {}) : std::deque<Order>();
  }
  /// All that wait, for sure; not for the owner's loop.
  [[nodiscard]] std::deque<Order> take_all() {
    const std::lock_guard lock(mutex_);
    return std::exchange(orders_, {});
  }

 private:
  static constexpr std::size_t kMost = 16;
  std::mutex mutex_;
  std::deque<Order> orders_;
};

}  // namespace hydroprint::rig
