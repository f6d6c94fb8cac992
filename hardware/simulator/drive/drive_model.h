#pragma once

#include <optional>

#include "hardware/drive/profile.h"
#include "hardware/simulator/drive/motion.h"

namespace hydroprint::simulated_drive {

/// What the drive's watchdog does.
enum class WatchdogAction { kNothing, kStop };

/// The axis and how its drive is set up. World coordinate: 0 at the edge of the home switch, which
/// is pressed above (x <= 0); positive down.
struct Machine {
  double travel_mm = 300;
  double end_switches_beyond_mm = 5;  ///< pressed so far above 0 and below `travel`
  double hard_stops_beyond_mm = 8;    ///< the carriage goes no further
  double max_speed_mm_per_s = 20;
  double acceleration_mm_per_s2 = 200;
  double stopping_deceleration_mm_per_s2 = 200;  ///< of stop, watchdog, alarms and the brake
  double homing_speed_mm_per_s = 10;
  double back_off_speed_mm_per_s = 1;
  double largest_following_error_mm = 1;
  double jog_dead_man_s = 0.2;  ///< 0: jogs need no refreshing
  double watchdog_s = 0.25;     ///< 0: off
  WatchdogAction watchdog_action = WatchdogAction::kStop;
  bool enables_itself = false;  ///< has no command for it
};

/// What comes from outside, or breaks.
struct Inputs {
  bool stop_button = false;
  bool positive_end = false;  ///< switch pressed wherever the carriage is
  bool negative_end = false;
  bool stalled = false;  ///< the carriage is held
  bool frozen = false;   ///< the encoder tells nothing new
};

/// Alarm codes of the virtual drive; hardware/profiles/virtual.toml says what to do about each.
enum AlarmCode : int {
  kNoAlarm = 0,
  kFollowingError = 0x10,
  kPositiveEnd = 0x20,
  kNegativeEnd = 0x21,
  kWatchdog = 0x30,
  kHomingFailed = 0x40,
};

/// What the drive is at.
enum class Mode {
  kOff,
  kHold,
  kMove,
  kJog,
  kHomeSeek,     ///< up to the switch
  kHomeBackOff,  ///< slowly down until it releases
  kHomeToZero,
  kStopToHold,
  kStopToOff,
};

/// All that changes.
struct Model {
  double time_s = 0;
  Mode mode = Mode::kOff;
  Goal goal;
  Kinematics demand;   ///< the drive's trajectory, world
  Kinematics actual;   ///< the carriage, world
  double zero_mm = 0;  ///< world coordinate that the drive calls 0
  bool homed = false;
  int alarm = kNoAlarm;
  double heard_s = 0;    ///< when the last request came
  double jogged_s = 0;   ///< when the last jog command came
  double frozen_mm = 0;  ///< what the encoder said last
  double rested_s = 0;   ///< when the carriage last came to rest

  [[nodiscard]] bool enabled() const { return mode != Mode::kOff && mode != Mode::kStopToOff; }
  [[nodiscard]] bool moving() const { return mode != Mode::kOff && mode != Mode::kHold; }
};

/// A drive that was just switched on, its carriage at rest at `x_mm`.
[[nodiscard]] Model switched_on(double x_mm);

/// Switches tell, pressed by the carriage or by `inputs`.
[[nodiscard]] bool at_home_switch(const Model& model);
[[nodiscard]] bool at_positive_end(const Machine& machine, const Model& model,
                                   const Inputs& inputs);
[[nodiscard]] bool at_negative_end(const Machine& machine, const Model& model,
                                   const Inputs& inputs);

/// What the drive tells of position and velocity, from its zero.
[[nodiscard]] Kinematics told(const Model& model, const Inputs& inputs);

/// The same drive `dt_s` later. Motion is exact; switches, watchdog and dead-man are looked at
/// every millisecond, as a drive does.
[[nodiscard]] Model step(const Machine& machine, Model model, const Inputs& inputs, double dt_s);

/// A command as it came over the wire; what it does not take is 0.
struct Order {
  drive::Command command = drive::Command::kStop;
  double position_mm = 0;
  double speed_mm_per_s = 0;
  double acceleration_mm_per_s2 = 0;  ///< 0: the machine's
};

/// The drive after an order; none if its state forbids it (alarm, stop button, not enabled, motion
/// into a pressed end switch). A move that comes while another is on replaces it.
[[nodiscard]] std::optional<Model> obey(const Machine& machine, Model model, const Inputs& inputs,
                                        const Order& order);

}  // namespace hydroprint::simulated_drive
