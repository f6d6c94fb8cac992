#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hardware/drive/block_parts.h"
#include "hardware/drive/profile.h"
#include "hardware/drive/transaction.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// The state of a drive at one point in time.
struct DriveState {
  double position_mm = 0;  ///< relative to the home switch; meaningless before homing
  /// If the profile has no velocity: the mean velocity since the last poll; 0 at the first poll
  /// after connecting, and after more than kStale_s without one.
  double velocity_mm_per_s = 0;
  std::optional<double> demand_mm;  ///< position of the drive's own trajectory, if reported
  bool enabled = false;
  bool homed = false;
  bool moving = false;
  bool alarm = false;
  bool positive_end = false;  ///< limit switch pressed
  bool negative_end = false;
  bool home_switch = false;
  bool stop_input = false;  ///< stop button pressed
  int alarm_code = 0;       ///< 0: none
  std::string alarm_text;   ///< empty: none
  std::string alarm_hint;   ///< remedy
  /// Time of the position: the midpoint between sending the request and receiving its reply, and
  /// the uncertainty of that time.
  std::chrono::steady_clock::time_point time;
  std::chrono::duration<double> time_error{0};
};

/// The result of connect().
struct Inspection {
  std::string drive;      ///< name in the profile
  double watchdog_s = 0;  ///< as read back from the drive; 0: off, or no watchdog
  /// Reason why this drive must not be armed in its current configuration (kFailedPrecondition,
  /// reason DRIVE_CONFIG_UNSAFE); nullopt if it may be armed.
  std::optional<Error> unsafe;
};

/// A drive, controlled as described by its profile. Only one thread at a time may call it; other
/// threads use StopLine. Every call ends after a bounded number of requests, each limited by the
/// link's timing.
/// Reads may be repeated; commands are sent once. A command that fails with metadata `timeout` may
/// have taken effect. After any failure of the link the state is unknown: enable, home, move_to and
/// jog return RIG_OFFLINE until a poll() succeeds. They return DRIVE_CONFIG_UNSAFE if connect()
/// found the configuration unsafe. disable and stop are always sent. Errors: RIG_OFFLINE,
/// DRIVE_CONFIG_UNSAFE and those of decode_reply; kOutOfRange, reason LIMIT_EXCEEDED, for values
/// beyond the limits of the profile or the registers.
class Drive {
 public:
  Drive(DriveProfile profile, std::shared_ptr<Link> link);

  /// Connects or reconnects, checks that this is the profile's drive and reads back its watchdog.
  /// Returns RIG_OFFLINE on failure. For another drive it returns kFailedPrecondition, reason
  /// DRIVE_CONFIG_UNSAFE, and disconnects.
  [[nodiscard]] Result<Inspection> connect();
  void disconnect();

  /// Returns whether the drive is connected. If not, poll() and motion fail until connect()
  /// succeeds.
  [[nodiscard]] bool connected() const;

  /// Reads all blocks and checks their marks. If a reply is damaged, missing or late, reads that
  /// block again at once, in other parts (block_parts.h), and the next polls read it in these parts
  /// until that reply can no longer arrive. Reads only one block again, so the duration stays
  /// within recovery_time_s (link_budget.h) if no other reply is bad.
  /// @param repeat_until  after this time, nothing is read again, because the caller will not wait
  [[nodiscard]] Result<DriveState> poll(std::chrono::steady_clock::time_point repeat_until =
                                            std::chrono::steady_clock::time_point::max());

  [[nodiscard]] Status enable();
  [[nodiscard]] Status disable();

  /// Starts homing, which the drive performs on its own: it reports first moving, then homed.
  [[nodiscard]] Status home();

  /// Starts a move at constant speed (except for the profile's ramps); the speed must be above 0.
  [[nodiscard]] Status move_to(double position_mm, double speed_mm_per_s);

  /// Starts or continues motion at a speed of either sign, not 0. Must be called again at least
  /// every profile().jog_refresh_s. The motion ends with stop(), or profile().jog_dead_man_s after
  /// the last call.
  [[nodiscard]] Status jog(double speed_mm_per_s);

  /// Brakes the axis; the drive stays enabled.
  [[nodiscard]] Status stop();

  /// Clears an alarm whose cause has been removed. Moves nothing.
  [[nodiscard]] Status reset_fault();

  [[nodiscard]] const DriveProfile& profile() const { return profile_; }
  [[nodiscard]] const std::shared_ptr<Link>& link() const { return link_; }

 private:
  /// What a poll has read so far.
  struct Polled {
    std::vector<std::vector<std::uint16_t>> blocks;
    std::chrono::steady_clock::time_point time;  // of the position
    std::chrono::steady_clock::duration spread{};
    bool repeated = false;  // a block has been read again
    std::chrono::steady_clock::time_point repeat_until;
  };

  [[nodiscard]] Status check_identity();
  [[nodiscard]] std::optional<Error> find_rtu_over_tcp(const Error& error) const;
  [[nodiscard]] Result<Inspection> inspect_watchdog();
  [[nodiscard]] double derive_velocity(const DriveState& state);
  [[nodiscard]] Status may_move() const;
  [[nodiscard]] Status command(Command which, double position_mm, double speed_mm_per_s);
  [[nodiscard]] Status read_block(const Block& block, Polled& polled);
  [[nodiscard]] Status read_parts(const Block& block, bool whole, Polled& polled);
  [[nodiscard]] Status read_part(const Block& block, const Part& part, Polled& polled);
  [[nodiscard]] Request read_request(Space space, std::uint16_t address, std::uint16_t count) const;
  [[nodiscard]] Result<std::vector<std::uint16_t>> read(Space space, std::uint16_t address,
                                                        std::uint16_t count);
  template <class T>
  Result<T> noted(Result<T> result);

  DriveProfile profile_;
  std::shared_ptr<Link> link_;
  /// Position and time of the last poll, if the velocity is derived from them.
  std::optional<std::pair<double, std::chrono::steady_clock::time_point>> last_;
  bool known_ = false;  // a poll succeeded, and the link has not failed since
  // The connection that was inspected; StopLine may have reconnected since then.
  std::uint64_t connection_ = 0;
  std::optional<Error> unsafe_;
};

}  // namespace hydroprint::drive
