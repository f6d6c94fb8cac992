#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "hardware/rig/axis_observer.h"
#include "hardware/rig/command_queue.h"
#include "hardware/rig/link_monitor.h"
#include "hardware/rig/motion_log.h"
#include "hardware/rig/motion_supervisor.h"
#include "hardware/rig/stop_channel.h"

namespace hydroprint::rig {

/// State shared by the controller's callers and the control loop. The control loop never waits for
/// a caller.
struct SharedState {
  CommandQueue orders;
  RigStatus status;
  std::atomic<std::uint64_t> stops{0};  ///< number of stops requested
  std::atomic<bool> end{false};
};

/// The only thread that polls and commands the drive (StopChannel only stops it). It polls at a
/// fixed period, feeds the state machine, and executes the resulting actions.
class ControlLoop {
 public:
  /// @param drive, stop_channel, shared  must outlive this object
  ControlLoop(const RigConfig& config, drive::Drive& drive, StopChannel& stop_channel,
              SharedState& shared);

  /// Runs until shared.end is set; then stops the axis, disables its torque and releases the drive.
  void run();

 private:
  [[nodiscard]] ThreadPriority raise_priority() const;
  void tick();
  void take_stops();
  void look();
  void follow(const drive::DriveState& axis);
  [[nodiscard]] bool observe(const drive::DriveState& axis);
  void fall_silent(Cause cause);
  [[nodiscard]] double silence_s() const;
  void take_orders();
  void keep_going();
  void publish();
  void shut_down();

  /// Feeds an event to the state machine and executes the resulting actions, except for starting a
  /// motion.
  Step apply(const Event& event);
  void note_change(const Condition& before);
  [[nodiscard]] Status act(const Actions& actions);
  void send_stop();
  void lose();

  void carry_out(Order& order);
  [[nodiscard]] Answer begin(const Order& order);
  [[nodiscard]] Status command(const Order& order);
  [[nodiscard]] Status send_surely(const std::function<Status()>& send);
  [[nodiscard]] Status command_leg(const Leg& leg);
  void answer(Order& order, Answer answer);
  void answer_waiting();
  void refuse_all();

  void record(const drive::DriveState& axis);
  [[nodiscard]] Bits settled(Bits bits);

  RigConfig config_;
  drive::Drive& drive_;
  StopChannel& stop_channel_;
  SharedState& shared_;
  LinkMonitor link_monitor_;
  AxisObserver observer_;
  MotionLog log_;
  Condition condition_;
  std::optional<drive::DriveState> axis_;
  std::optional<MotionSupervisor> supervisor_;
  std::uint64_t stops_ = 0;  // number of the stops in shared_.stops that have been processed
  int still_ = 0;            // number of consecutive polls at standstill, while STOPPING
  TimePoint jogged_, stop_sent_, stopping_since_;
  std::optional<TimePoint> stop_acknowledged_;  // of the current STOPPING
  std::vector<Order> waiting_;                  // orders waiting for confirmation by the drive
  /// Responses that are sent once the snapshot shows their effect.
  std::vector<std::pair<std::promise<Answer>, Answer>> answers_;
  TimePoint pending_since_;
  Jitter jitter_;
  ThreadPriority priority_;
};

}  // namespace hydroprint::rig
