#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "client/cli/terminal/terminal.h"
#include "client/rig.h"

namespace hydroprint::cli {

/// Makes a held key a jog. A terminal tells of a key that is held by repeating it, after a delay
/// that is the keyboard's (often half a second), and never of its release. So each key event moves
/// the axis for kHeldFor, the next event prolongs that, and without one the axis is stopped: a tap
/// is a short step, and a key that is held moves on once it repeats. Bridging the first delay
/// instead would let go half a second late, every time.
class Jogger {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Time for which one key event moves the axis.
  static constexpr std::chrono::milliseconds kHeldFor{200};
  /// How often the daemon is told that the key is held.
  static constexpr std::chrono::milliseconds kPeriod{100};

  /// @param speed_mm_per_s  above 0
  Jogger(client::Connection& daemon, std::string lease_id, double speed_mm_per_s);
  /// Stops the axis if it is jogged.
  ~Jogger();
  Jogger(const Jogger&) = delete;
  Jogger& operator=(const Jogger&) = delete;

  /// Takes a key: a direction holds, faster and slower double and halve the speed, any other lets
  /// go.
  void press(Key key, TimePoint now);
  /// To be called at least every 50 ms: jogs while a key is held, and stops the axis when it is let
  /// go. What the rig refuses for the time being (a limit, a motion that has to end) is told by
  /// text().
  /// @return the rig's answer, if it was asked; what makes going on pointless
  [[nodiscard]] Result<std::optional<client::Rig>> tick(TimePoint now);

  /// "down at 5.00 mm/s", or why not.
  [[nodiscard]] std::string text() const;
  /// Whether a key is held, or the axis was not told to stop yet.
  [[nodiscard]] bool is_held() const { return direction_ != 0 || moved_; }

 private:
  [[nodiscard]] Result<std::optional<client::Rig>> let_go();

  client::Connection& daemon_;
  std::string lease_id_;
  double speed_mm_per_s_;
  int direction_ = 0;  // 1 down, -1 up, 0 at rest
  TimePoint pressed_, told_;
  bool moved_ = false;   // the daemon was told to jog, and not to stop since
  std::string refusal_;  // why the latest jog was not obeyed
};

}  // namespace hydroprint::cli
