#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "client/cli/terminal/terminal.h"
#include "client/rig.h"

namespace hydroprint::cli {

/// Converts key events to jog commands. A terminal reports a held key by repeating it after a delay
/// (often half a second), and does not report its release. Each key event therefore moves the axis
/// for kHeldFor, and the next event extends the motion. Without a further event the axis stops: a
/// tap is a short step, and a held key continues the motion once it repeats. If the motion bridged
/// the first delay, the axis would stop half a second late after every release.
class Jogger {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Duration of the motion for one key event.
  static constexpr std::chrono::milliseconds kHeldFor{200};
  /// Interval of the jog commands while a key is held.
  static constexpr std::chrono::milliseconds kPeriod{100};

  /// @param speed_mm_per_s  above 0
  Jogger(client::Connection& daemon, std::string lease_id, double speed_mm_per_s);
  /// Stops a jog in progress.
  ~Jogger();
  Jogger(const Jogger&) = delete;
  Jogger& operator=(const Jogger&) = delete;

  /// Handles a key: directions start a jog, faster and slower double and halve the speed, any other
  /// key stops.
  void press(Key key, TimePoint now);
  /// Jogs while a key is held, and stops the axis after its release. Must be called at least every
  /// 50 ms. text() contains temporary refusals of the rig (a limit, a motion that has to end).
  /// @return the rig's response, if a command was sent; an error if jogging cannot continue
  [[nodiscard]] Result<std::optional<v1::Rig>> tick(TimePoint now);

  /// Returns "down at 5.00 mm/s", or the reason why the axis does not move.
  [[nodiscard]] std::string text() const;
  /// Returns whether a key is held, or the stop has not been sent yet.
  [[nodiscard]] bool is_held() const { return direction_ != 0 || moved_; }

 private:
  [[nodiscard]] Result<std::optional<v1::Rig>> release();

  client::Connection& daemon_;
  std::string lease_id_;
  double speed_mm_per_s_;
  int direction_ = 0;  // 1 down, -1 up, 0 at standstill
  TimePoint pressed_, last_sent_;
  bool moved_ = false;   // a jog was sent, and no stop since then
  std::string refusal_;  // why the last jog was refused
};

}  // namespace hydroprint::cli
