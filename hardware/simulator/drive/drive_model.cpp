#include "hardware/simulator/drive/drive_model.h"

#include <algorithm>
#include <cmath>

namespace hydroprint::simulated_drive {
namespace {

using drive::Command;

constexpr double kScan_s = 1e-3;
// Speed of a carriage that is released after a stall, as a multiple of the largest speed.
constexpr double kCatchUp = 3;
// Homing leaves the switch by this distance, so that its state and the homed bit change for a time
// that a master can observe, also if the carriage was at home already.
constexpr double kClearOfSwitch_mm = 0.1;

constexpr double kRunaway_mm_per_s = 25;
constexpr double kDrift_mm_per_s = 0.15;

Goal velocity_goal(const Machine& machine, double v_mm_per_s) {
  return {Goal::Kind::kVelocity, 0, v_mm_per_s, machine.acceleration_mm_per_s2,
          machine.acceleration_mm_per_s2};
}

Goal stop_goal(const Machine& machine) {
  Goal goal = velocity_goal(machine, 0);
  goal.deceleration_mm_per_s2 = machine.stopping_deceleration_mm_per_s2;
  return goal;
}

Goal position_goal(const Machine& machine, double x_mm, double speed_mm_per_s) {
  return {Goal::Kind::kPosition, x_mm, speed_mm_per_s, machine.acceleration_mm_per_s2,
          machine.acceleration_mm_per_s2};
}

void brake(const Machine& machine, Model& model, Mode mode) {
  if (model.mode == Mode::kOff || model.mode == Mode::kStopToOff) return;
  model.goal = stop_goal(machine);
  model.mode = mode;
}

void raise(const Machine& machine, Model& model, int alarm) {
  if (model.alarm == kNoAlarm) model.alarm = alarm;
  brake(machine, model, Mode::kStopToOff);
}

bool is_homing(const Model& model) {
  return model.mode == Mode::kHomeSeek || model.mode == Mode::kHomeBackOff ||
         model.mode == Mode::kHomeToZero;
}

/// Returns the direction of the commanded motion: -1, 0 or 1.
int direction(const Model& model) {
  const double ahead = model.goal.kind == Goal::Kind::kPosition
                           ? model.goal.target_mm - model.demand.x_mm
                           : model.goal.speed_mm_per_s;
  return (ahead > 0) - (ahead < 0);
}

bool runs_into_switch(const Machine& machine, const Model& model, const Inputs& inputs) {
  const int way = direction(model);
  return (way > 0 && at_positive_end(machine, model, inputs)) ||
         (way < 0 && at_negative_end(machine, model, inputs));
}

void move_carriage(const Machine& machine, Model& model, const Inputs& inputs, double dt_s) {
  model.demand = advance(model.demand, model.goal, dt_s);
  const Kinematics before = model.actual;
  if (!inputs.stalled) {
    const double reach = kCatchUp * machine.max_speed_mm_per_s * dt_s;
    const double gap = model.demand.x_mm - before.x_mm;
    model.actual.x_mm =
        std::abs(gap) <= reach ? model.demand.x_mm : before.x_mm + std::copysign(reach, gap);
    model.actual.x_mm = std::clamp(model.actual.x_mm, -machine.hard_stops_beyond_mm,
                                   machine.travel_mm + machine.hard_stops_beyond_mm);
  }
  model.actual.v_mm_per_s = model.actual.x_mm == model.demand.x_mm
                                ? model.demand.v_mm_per_s
                                : (model.actual.x_mm - before.x_mm) / dt_s;
}

/// Moves the carriage without an order.
void run_away(const Machine& machine, Model& model, double v_mm_per_s, double dt_s) {
  const double x_mm =
      std::clamp(model.actual.x_mm + v_mm_per_s * dt_s, -machine.hard_stops_beyond_mm,
                 machine.travel_mm + machine.hard_stops_beyond_mm);
  model.actual = model.demand = {x_mm, v_mm_per_s};
}

void look_at_switches(const Machine& machine, Model& model, const Inputs& inputs) {
  if (!model.enabled()) return;
  if (inputs.stop_button) brake(machine, model, Mode::kStopToOff);
  if (model.mode == Mode::kHold || model.mode == Mode::kStopToHold) return;
  if (!runs_into_switch(machine, model, inputs)) return;
  const int alarm = direction(model) > 0 ? kPositiveEnd : kNegativeEnd;
  raise(machine, model, is_homing(model) ? kHomingFailed : alarm);
}

void look_at_clocks(const Machine& machine, Model& model) {
  const double slack = 1e-9;  // tolerance for sums of milliseconds
  const bool watched =
      machine.watchdog_s > 0 && model.enabled() && machine.watchdog_action == WatchdogAction::kStop;
  if (watched && model.time_s - model.heard_s > machine.watchdog_s - slack) {
    raise(machine, model, kWatchdog);
  }
  if (model.mode == Mode::kJog && machine.jog_dead_man_s > 0 &&
      model.time_s - model.jogged_s > machine.jog_dead_man_s - slack) {
    brake(machine, model, Mode::kStopToHold);
  }
}

void go_on_homing(const Machine& machine, Model& model) {
  if (model.mode == Mode::kHomeSeek && at_home_switch(model)) {
    model.mode = Mode::kHomeBackOff;
    model.goal = velocity_goal(machine, machine.back_off_speed_mm_per_s);
  } else if (model.mode == Mode::kHomeBackOff && model.actual.x_mm >= kClearOfSwitch_mm) {
    model.zero_mm = 0;  // the switch's edge
    model.mode = Mode::kHomeToZero;
    model.goal = position_goal(machine, model.zero_mm, machine.back_off_speed_mm_per_s);
  }
}

void finish(Model& model) {
  if (model.mode == Mode::kHomeSeek || model.mode == Mode::kHomeBackOff ||
      model.mode == Mode::kJog || !is_reached(model.demand, model.goal)) {
    return;
  }
  model.homed = model.homed || model.mode == Mode::kHomeToZero;
  if (model.mode == Mode::kStopToOff) {
    model.mode = Mode::kOff;
    model.demand = {model.actual.x_mm, 0};
    model.actual.v_mm_per_s = 0;
  } else if (model.mode != Mode::kOff) {
    model.mode = Mode::kHold;
  }
}

void scan(const Machine& machine, Model& model, const Inputs& inputs, double dt_s) {
  const bool moved = model.actual.v_mm_per_s != 0;
  model.time_s += dt_s;
  if (model.enabled() && (inputs.runaway || inputs.drifting)) {
    run_away(machine, model, inputs.runaway ? kRunaway_mm_per_s : kDrift_mm_per_s, dt_s);
  } else if (model.mode != Mode::kOff) {
    move_carriage(machine, model, inputs, dt_s);
  }
  if (!inputs.frozen) model.frozen_mm = model.actual.x_mm;
  look_at_switches(machine, model, inputs);
  look_at_clocks(machine, model);
  go_on_homing(machine, model);
  if (model.enabled() &&
      std::abs(model.demand.x_mm - model.actual.x_mm) > machine.largest_following_error_mm) {
    raise(machine, model, kFollowingError);
  }
  finish(model);
  if (moved && model.actual.v_mm_per_s == 0) model.rested_s = model.time_s;
  const bool may_enable = model.alarm == kNoAlarm && !inputs.stop_button;
  if (machine.enables_itself && model.mode == Mode::kOff && may_enable) model.mode = Mode::kHold;
}

/// Starts a motion, unless it is forbidden.
std::optional<Model> start(const Machine& machine, Model model, const Inputs& inputs, Mode mode,
                           const Goal& goal) {
  const bool ready = model.enabled() && model.alarm == kNoAlarm && !inputs.stop_button;
  model.mode = mode;
  model.goal = goal;
  if (!ready || runs_into_switch(machine, model, inputs)) return std::nullopt;
  return model;
}

std::optional<Model> start_homing(const Machine& machine, Model model, const Inputs& inputs) {
  const bool on_switch = at_home_switch(model);
  model.homed = false;
  return start(machine, model, inputs, on_switch ? Mode::kHomeBackOff : Mode::kHomeSeek,
               velocity_goal(machine, on_switch ? machine.back_off_speed_mm_per_s
                                                : -machine.homing_speed_mm_per_s));
}

Goal goal_of(const Machine& machine, const Model& model, const Order& order) {
  const double speed = std::min(order.speed_mm_per_s, machine.max_speed_mm_per_s);
  Goal goal = order.command == Command::kMove
                  ? position_goal(machine, model.zero_mm + order.position_mm, speed)
                  : velocity_goal(machine, order.command == Command::kJogNegative ? -speed : speed);
  if (order.acceleration_mm_per_s2 > 0) {
    goal.acceleration_mm_per_s2 =
        std::min(order.acceleration_mm_per_s2, machine.acceleration_mm_per_s2);
    goal.deceleration_mm_per_s2 = goal.acceleration_mm_per_s2;
  }
  return goal;
}

std::optional<Model> switch_on(Model model, const Inputs& inputs) {
  if (model.alarm != kNoAlarm || inputs.stop_button) return std::nullopt;
  if (model.mode == Mode::kStopToOff) return std::nullopt;
  if (model.mode == Mode::kOff) {
    model.mode = Mode::kHold;
    model.goal = {};
  }
  return model;
}

}  // namespace

Model switched_on(double x_mm) {
  Model model;
  model.demand.x_mm = model.actual.x_mm = model.zero_mm = model.frozen_mm = x_mm;
  return model;
}

bool at_home_switch(const Model& model) { return model.actual.x_mm <= 0; }

bool at_positive_end(const Machine& machine, const Model& model, const Inputs& inputs) {
  return inputs.positive_end ||
         model.actual.x_mm >= machine.travel_mm + machine.end_switches_beyond_mm;
}

bool at_negative_end(const Machine& machine, const Model& model, const Inputs& inputs) {
  return inputs.negative_end || model.actual.x_mm <= -machine.end_switches_beyond_mm;
}

Kinematics feedback(const Model& model, const Inputs& inputs) {
  if (inputs.frozen) return {model.frozen_mm - model.zero_mm, 0};
  return {model.actual.x_mm - model.zero_mm, model.actual.v_mm_per_s};
}

Model step(const Machine& machine, Model model, const Inputs& inputs, double dt_s) {
  while (dt_s > 0) {
    const double piece_s = std::min(dt_s, kScan_s);
    scan(machine, model, inputs, piece_s);
    dt_s -= piece_s;
  }
  return model;
}

std::optional<Model> execute(const Machine& machine, Model model, const Inputs& inputs,
                             const Order& order) {
  switch (order.command) {
    case Command::kEnable:
      return switch_on(model, inputs);
    case Command::kDisable:
      brake(machine, model, Mode::kStopToOff);
      return model;
    case Command::kHome:
      return start_homing(machine, model, inputs);
    case Command::kMove:
      return start(machine, model, inputs, Mode::kMove, goal_of(machine, model, order));
    case Command::kJogPositive:
    case Command::kJogNegative:
      model.jogged_s = model.time_s;
      return start(machine, model, inputs, Mode::kJog, goal_of(machine, model, order));
    case Command::kStop:
      if (model.moving() && !inputs.deaf) brake(machine, model, Mode::kStopToHold);
      return model;
    case Command::kResetFault:
      if (inputs.stop_button || model.mode == Mode::kStopToOff) return std::nullopt;
      model.alarm = kNoAlarm;
      return model;
  }
  return std::nullopt;
}

}  // namespace hydroprint::simulated_drive
