#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hardware/drive/profile.h"
#include "hardware/drive/transaction.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// What a drive said of itself at one moment.
struct DriveState {
  double position_mm = 0;  ///< from the home switch; means nothing before homing
  double velocity_mm_per_s = 0;
  std::optional<double> demand_mm;  ///< where the drive's own trajectory is, if it tells
  bool enabled = false;
  bool homed = false;
  bool moving = false;
  bool alarm = false;
  bool positive_end = false;  ///< end switch hit
  bool negative_end = false;
  bool home_switch = false;
  bool stop_input = false;  ///< stop button pressed
  int alarm_code = 0;       ///< 0: none
  std::string alarm_text;   ///< empty: none
  std::string alarm_hint;   ///< what to do about it
  /// Half way between request and reply of the position, and how far off that can be.
  std::chrono::steady_clock::time_point time;
  std::chrono::duration<double> time_error{0};
};

/// What connect() found.
struct Inspection {
  std::string drive;      ///< name in the profile
  double watchdog_s = 0;  ///< as read back; 0: off, or there is none
  /// Why this drive must not be armed as it is set up (kFailedPrecondition, reason
  /// DRIVE_CONFIG_UNSAFE); none: it may be.
  std::optional<Error> unsafe;
};

/// One drive, spoken to by its profile. One thread at a time may call (StopLine is for others);
/// every call ends after a bounded number of requests, each bounded by the link's timing.
///
/// Commands are sent once; one that fails with metadata `timeout` may or may not have been obeyed.
/// After any failure of the link the state is unknown: enable, home, move_to and jog refuse with
/// RIG_OFFLINE until a poll() succeeds; they refuse with DRIVE_CONFIG_UNSAFE what connect() found
/// unsafe. disable and stop are always sent. Errors: RIG_OFFLINE, DRIVE_CONFIG_UNSAFE and those of
/// decode_reply; kOutOfRange, reason LIMIT_EXCEEDED, for what the profile or the registers cannot
/// take.
class Drive {
 public:
  Drive(DriveProfile profile, std::shared_ptr<Link> link);

  /// Connects (anew, if it was connected), checks that this is the profile's drive and reads back
  /// its watchdog. Refuses with RIG_OFFLINE; with kFailedPrecondition, reason DRIVE_CONFIG_UNSAFE,
  /// another drive, from which it disconnects.
  [[nodiscard]] Result<Inspection> connect();
  void disconnect();

  /// False: connect() is needed before poll() and motion can succeed.
  [[nodiscard]] bool connected() const;

  /// Reads all blocks and checks their marks.
  [[nodiscard]] Result<DriveState> poll();

  [[nodiscard]] Status enable();
  [[nodiscard]] Status disable();

  /// Starts homing, which the drive does by itself: moving, then homed.
  [[nodiscard]] Status home();

  /// Starts a move at constant speed (apart from the profile's ramps); speed above 0.
  [[nodiscard]] Status move_to(double position_mm, double speed_mm_per_s);

  /// Starts or goes on with motion at a speed of either sign, not 0; to be called again at least
  /// every profile().jog_refresh_s. Ends by stop(), or by itself if it is not called again for
  /// profile().jog_dead_man_s.
  [[nodiscard]] Status jog(double speed_mm_per_s);

  /// Brakes; the drive stays enabled.
  [[nodiscard]] Status stop();

  /// Clears an alarm whose cause is gone; moves nothing.
  [[nodiscard]] Status reset_fault();

  [[nodiscard]] const DriveProfile& profile() const { return profile_; }
  [[nodiscard]] const std::shared_ptr<Link>& link() const { return link_; }

 private:
  [[nodiscard]] Status check_identity();
  [[nodiscard]] Result<Inspection> inspect_watchdog();
  [[nodiscard]] Status may_move() const;
  [[nodiscard]] Status command(Command which, double position_mm, double speed_mm_per_s);
  [[nodiscard]] Result<std::vector<std::uint16_t>> read(Space space, std::uint16_t address,
                                                        std::uint16_t count);
  template <class T>
  Result<T> noted(Result<T> result);

  DriveProfile profile_;
  std::shared_ptr<Link> link_;
  bool known_ = false;            // the last thing that happened to the link was no failure
  std::uint64_t connection_ = 0;  // that was inspected; StopLine may have made another
  std::optional<Error> unsafe_;
};

}  // namespace hydroprint::drive
