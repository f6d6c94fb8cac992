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

/// What a request gets: unit, function and data (nothing if the drive says nothing), and what is
/// wrong with it.
struct Answer {
  std::vector<std::uint8_t> reply;
  ReplyFault reply_fault;
};

/// The one physical state, moved by the one clock. Any thread may call; every call first brings the
/// state up to now.
class Plant {
 public:
  Plant(const Machine& machine, Registers registers, double start_mm);

  /// Obeys a request (unit, function, data), which may be anything.
  [[nodiscard]] Answer answer(std::span<const std::uint8_t> request);

  /// Brings the state up to now.
  void tick();

  /// From now on strikes replies so.
  void set_reply_fault(const ReplyFault& reply_fault);

  void press(Action::Input input, bool pressed);

  /// No faults any more, nothing pressed, stalled or frozen.
  void clear();

  /// Power fails: the brake stops the axis, nothing is heard. Power returns: nothing is known.
  void power_off();
  void power_on();

  /// The time, and where the carriage truly is then.
  struct Place {
    double time_s = 0;
    double x_mm = 0;
  };
  [[nodiscard]] Place place();

  /// All of the state as JSON on one line, for people and tests.
  [[nodiscard]] std::string state_json();

  [[nodiscard]] int unit() const;

 private:
  void catch_up();
  void tell();
  [[nodiscard]] ReplyFault next_fault();
  [[nodiscard]] std::vector<std::uint8_t> obey_request(std::span<const std::uint8_t> request);
  [[nodiscard]] std::vector<std::uint8_t> obey_read(std::span<const std::uint8_t> request);
  [[nodiscard]] std::vector<std::uint8_t> obey_write(std::span<const std::uint8_t> request);

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
