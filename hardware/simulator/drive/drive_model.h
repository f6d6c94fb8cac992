#pragma once

#include <optional>

#include "hardware/drive/profile.h"
#include "hardware/simulator/drive/motion.h"

namespace hydroprint::simulated_drive {

/// The action of the drive's watchdog.
enum class WatchdogAction { kNothing, kStop };

/// The axis and the settings of its drive. World coordinate: 0 at the edge of the home switch,
/// which is pressed at x <= 0; positive is down.
struct Machine {
  double travel_mm = 300;
  /// Distance of the limit switches from the ends of the travel.
  double end_switches_beyond_mm = 5;
  double hard_stops_beyond_mm = 8;  ///< distance of the hard stops from the ends of the travel
  double max_speed_mm_per_s = 20;
  double acceleration_mm_per_s2 = 200;
  /// Deceleration of stop, watchdog, alarms and the brake.
  double stopping_deceleration_mm_per_s2 = 200;
  double homing_speed_mm_per_s = 10;
  double back_off_speed_mm_per_s = 1;
  double largest_following_error_mm = 1;
  double jog_dead_man_s = 0.2;  ///< time after its last command at which a jog ends; 0: never
  double watchdog_s = 0.25;     ///< 0: off
  WatchdogAction watchdog_action = WatchdogAction::kStop;
  bool enables_itself = false;  ///< holds torque without an enable command
};

/// External inputs and faults.
struct Inputs {
  bool stop_button = false;
  bool positive_end = false;  ///< switch pressed wherever the carriage is
  bool negative_end = false;
  bool stalled = false;  ///< the carriage is blocked
  bool frozen = false;   ///< the encoder value does not change
  bool deaf = false;     ///< stops are acknowledged, but not obeyed
  // The drive itself moves the carriage, and reports it, until its torque is taken off.
  bool runaway = false;   ///< at 25 mm/s
  bool drifting = false;  ///< at 0.15 mm/s
};

/// Alarm codes of the virtual drive; hardware/profiles/virtual.toml describes the remedies.
enum AlarmCode : int {
  kNoAlarm = 0,
  kFollowingError = 0x10,
  kPositiveEnd = 0x20,
  kNegativeEnd = 0x21,
  kWatchdog = 0x30,
  kHomingFailed = 0x40,
};

/// The activity of the drive.
enum class Mode {
  kOff,
  kHold,
  kMove,
  kJog,
  kHomeSeek,     ///< moves up until the switch is pressed
  kHomeBackOff,  ///< moves down slowly until the switch is released
  kHomeToZero,
  kStopToHold,
  kStopToOff,
};

/// The complete variable state of the drive.
struct Model {
  double time_s = 0;
  Mode mode = Mode::kOff;
  Goal goal;
  Kinematics demand;   ///< the drive's trajectory, world coordinate
  Kinematics actual;   ///< the carriage, world coordinate
  double zero_mm = 0;  ///< world coordinate of the drive's position 0
  bool homed = false;
  int alarm = kNoAlarm;
  double heard_s = 0;    ///< time of the last request
  double jogged_s = 0;   ///< time of the last jog command
  double frozen_mm = 0;  ///< last value of the encoder
  double rested_s = 0;   ///< when the carriage last came to rest

  [[nodiscard]] bool enabled() const { return mode != Mode::kOff && mode != Mode::kStopToOff; }
  [[nodiscard]] bool moving() const { return mode != Mode::kOff && mode != Mode::kHold; }
};

/// Returns a drive that has just been switched on, with its carriage at rest at `x_mm`.
[[nodiscard]] Model switched_on(double x_mm);

/// Return the states of the switches, which the carriage or `inputs` press.
[[nodiscard]] bool at_home_switch(const Model& model);
[[nodiscard]] bool at_positive_end(const Machine& machine, const Model& model,
                                   const Inputs& inputs);
[[nodiscard]] bool at_negative_end(const Machine& machine, const Model& model,
                                   const Inputs& inputs);

/// Returns position and velocity as reported by the drive, relative to its zero.
[[nodiscard]] Kinematics feedback(const Model& model, const Inputs& inputs);

/// Advances the drive by `dt_s`. Motion is computed exactly; switches, watchdog and dead-man timer
/// are checked every millisecond, as in a real drive.
[[nodiscard]] Model step(const Machine& machine, Model model, const Inputs& inputs, double dt_s);

/// A decoded command; unused fields are 0.
struct Order {
  drive::Command command = drive::Command::kStop;
  double position_mm = 0;
  double speed_mm_per_s = 0;
  double acceleration_mm_per_s2 = 0;  ///< 0: the default of the machine
};

/// Executes an order; returns nullopt if the state forbids it (alarm, stop button, not enabled,
/// motion into a pressed limit switch). A move replaces a move in progress.
[[nodiscard]] std::optional<Model> execute(const Machine& machine, Model model,
                                           const Inputs& inputs, const Order& order);

}  // namespace hydroprint::simulated_drive
