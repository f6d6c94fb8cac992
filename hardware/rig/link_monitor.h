#pragma once

#include <optional>

#include "hardware/drive/drive.h"
#include "hardware/rig/samples.h"
#include "hardware/rig/state.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// Looks at the drive: connects, polls, tells a miss from a loss, and tries again, ever more
/// seldom. After a loss nothing is believed before the drive was inspected anew.
class LinkMonitor {
 public:
  /// @param drive  outlives it
  explicit LinkMonitor(drive::Drive& drive) : drive_(drive) {}

  struct Look {
    std::optional<Event> event;  ///< kSeen, kSample or kLost; none: missed, or not tried
    std::optional<drive::DriveState> axis;
  };
  /// One look; takes a bounded number of requests.
  [[nodiscard]] Look look();
  /// From outside: what was last seen does not count any more.
  void lose();
  /// Says nothing to the drive for so long, so that its watchdog acts.
  void keep_silent(double silence_s);

  /// The drive answers, as far as is known.
  [[nodiscard]] bool is_up() const { return up_; }
  /// When it was last seen clean.
  [[nodiscard]] TimePoint clean() const { return clean_; }
  /// Why it does not answer, or must not be armed.
  [[nodiscard]] const std::optional<Error>& trouble() const { return trouble_; }
  [[nodiscard]] double watchdog_s() const { return watchdog_s_; }
  [[nodiscard]] std::uint64_t missed() const { return missed_; }
  [[nodiscard]] std::uint64_t connects() const { return connects_; }

 private:
  [[nodiscard]] Status connect();
  [[nodiscard]] Look miss(Error error);

  drive::Drive& drive_;
  bool up_ = false;
  bool inspect_ = true;  ///< connect before the next poll, whatever the link says
  bool fresh_ = true;    ///< no look since the last inspection
  bool safe_ = false;
  double watchdog_s_ = 0;
  int misses_ = 0;  ///< in a row
  TimePoint clean_, next_try_;
  std::chrono::milliseconds pause_{0};
  std::optional<Error> trouble_;
  std::uint64_t missed_ = 0, connects_ = 0;
};

/// What the state machine is shown of it.
[[nodiscard]] Bits bits_of(const drive::DriveState& axis);

}  // namespace hydroprint::rig
