#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "hardware/simulator/drive/drive_model.h"
#include "hardware/simulator/drive/faults.h"
#include "hardware/simulator/drive/registers.h"

namespace hydroprint::simulated_drive {

/// FIFO priority (become_real_time) of the threads that replace a drive. Greater than those of its
/// user, because a real drive does not wait for the user's processor.
inline constexpr int kDrivePriority = 12;

/// The reply to a request: unit, function and data (empty if the drive does not reply), and the
/// fault to apply to it.
struct Answer {
  std::vector<std::uint8_t> reply;
  ReplyFault reply_fault;
};

/// The physical state of the rig and its clock. Thread-safe; every call first advances the state to
/// the current time.
class Plant {
 public:
  Plant(const Machine& machine, Registers registers, double start_mm);

  /// Executes a request (unit, function, data), which is untrusted.
  [[nodiscard]] Answer answer(std::span<const std::uint8_t> request);

  /// Advances the state to the current time.
  void tick();

  /// Sets the fault for the next replies.
  void set_reply_fault(const ReplyFault& reply_fault);

  void press(Action::Input input, bool pressed);

  /// Clears all faults, including pressed, stalled and frozen inputs.
  void clear();

  /// Simulates a power failure: the brake stops the axis, and no requests are received. The drive
  /// loses its state.
  void power_off();
  void power_on();

  /// The time and the carriage's true position at that time.
  struct Place {
    double time_s = 0;
    double x_mm = 0;
  };
  [[nodiscard]] Place place();

  /// Returns the complete state as one line of JSON, for users and tests.
  [[nodiscard]] std::string state_json();

  [[nodiscard]] int unit() const;

 private:
  void catch_up();
  void update_registers();
  [[nodiscard]] ReplyFault next_fault(bool is_write);
  [[nodiscard]] std::vector<std::uint8_t> serve_request(std::span<const std::uint8_t> request);
  [[nodiscard]] std::vector<std::uint8_t> serve_read(std::span<const std::uint8_t> request);
  [[nodiscard]] std::vector<std::uint8_t> serve_write(std::span<const std::uint8_t> request);

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  Machine machine_;
  Registers registers_;
  Model model_;
  Inputs inputs_;
  ReplyFault fault_{ReplyFaultKind::kNone, {}, 0};
  bool powered_ = true;
  std::int64_t requests_ = 0;
};

}  // namespace hydroprint::simulated_drive
