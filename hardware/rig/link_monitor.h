#pragma once

#include <optional>

#include "hardware/drive/drive.h"
#include "hardware/rig/samples.h"
#include "hardware/rig/state.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// Monitors the drive: connects, polls, distinguishes a missed poll from a lost link, and
/// reconnects with growing pauses. After a loss, the drive is inspected again before its data is
/// used.
class LinkMonitor {
 public:
  /// @param drive  must outlive this object
  explicit LinkMonitor(drive::Drive& drive) : drive_(drive) {}

  struct Look {
    /// kSeen, kSample or kLost; nullopt: one poll failed, or none was due.
    std::optional<Event> event;
    std::optional<drive::DriveState> axis;
  };
  /// Polls the drive once, with a bounded number of requests.
  [[nodiscard]] Look look();
  /// Declares the link lost.
  void lose();
  /// Sends nothing to the drive for this long, so that its watchdog acts.
  void keep_silent(double silence_s);

  /// Returns whether the drive responds, as far as known.
  [[nodiscard]] bool is_up() const { return up_; }
  /// Returns the time of the last valid poll.
  [[nodiscard]] TimePoint clean() const { return clean_; }
  /// Returns why the drive does not respond, or must not be armed.
  [[nodiscard]] const std::optional<Error>& trouble() const { return trouble_; }
  [[nodiscard]] double watchdog_s() const { return watchdog_s_; }
  [[nodiscard]] std::uint64_t missed() const { return missed_; }
  [[nodiscard]] std::uint64_t connects() const { return connects_; }

 private:
  [[nodiscard]] Status connect();
  [[nodiscard]] Look miss(Error error);

  drive::Drive& drive_;
  bool up_ = false;
  bool inspect_ = true;  ///< connect before the next poll, even if the link is connected
  bool fresh_ = true;    ///< no poll since the last inspection
  bool safe_ = false;
  double watchdog_s_ = 0;
  int misses_ = 0;  ///< number of consecutive missed polls
  TimePoint clean_, next_try_;
  std::chrono::milliseconds pause_{0};
  std::optional<Error> trouble_;
  std::uint64_t missed_ = 0, connects_ = 0;
};

/// Returns the part of a drive's state that the state machine needs.
[[nodiscard]] Bits bits_of(const drive::DriveState& axis);

}  // namespace hydroprint::rig
