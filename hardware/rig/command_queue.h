#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <mutex>
#include <utility>
#include <vector>

#include "hardware/rig/motion_supervisor.h"

namespace hydroprint::rig {

/// The result of a command: the number of the motion that it started, or 0.
using Answer = Result<std::uint64_t>;

/// A command for the control loop.
struct Order {
  Event::Kind kind = Event::Kind::kArm;
  Plan plan = {};
  TimePoint given = {};
  std::uint64_t stops = 0;  ///< number of stops requested before this command
  std::promise<Answer> answer = {};
};

/// A short queue of commands, in order. Callers may wait for each other's access; the control loop
/// never waits.
class CommandQueue {
 public:
  /// Returns false if the queue is full; the order is then not stored.
  [[nodiscard]] bool put(Order& order) {
    const std::lock_guard lock(mutex_);
    if (orders_.size() >= kMost) return false;
    orders_.push_back(std::move(order));
    return true;
  }
  /// Takes all waiting orders. Returns an empty queue while a caller is adding an order; that order
  /// is taken the next time.
  [[nodiscard]] std::deque<Order> take() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock ? std::exchange(orders_, {}) : std::deque<Order>();
  }
  /// Takes all waiting orders and waits for the lock; not for use in the control loop.
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
