#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

#include "hardware/rig/samples.h"
#include "hardware/rig/state.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// What came of one motion.
struct MotionReport {
  enum class Outcome : std::uint8_t {
    kRunning,
    kDone,
    kStopped,  ///< because somebody asked, or let go of the jog
    kFailed,   ///< for `cause`
  };
  std::uint64_t number = 0;
  Motion motion = Motion::kNone;
  Outcome outcome = Outcome::kRunning;
  Cause cause = Cause::kNone;
  std::int32_t alarm_code = 0;  ///< the drive's, when it failed; 0: none
  bool at_rest = false;         ///< seen so since it ended
  double begin_mm = 0;
  double end_mm = 0;  ///< where it was last seen
  TimePoint begun, ended;
  TimePoint rested;                ///< when it was seen at rest
  std::uint64_t first_sample = 0;  ///< numbers in the SampleRing; its own samples and those of
  std::uint64_t last_sample = 0;   ///< the way to standstill
};

/// How regularly the owner looks at the drive.
struct Jitter {
  std::uint64_t ticks = 0;
  std::uint64_t skipped =
      0;                 ///< periods in which it did not look, because the last one took longer
  double largest_s = 0;  ///< latest that it ever was
  double rms_s = 0;      ///< of how late it was
};

/// All that the rig shows, at one moment.
struct Snapshot {
  Condition condition;
  TimePoint time;         ///< of the last clean look at the drive
  bool has_axis = false;  ///< the following were seen since the drive last answered
  Bits bits;
  double position_mm = 0;
  double velocity_mm_per_s = 0;
  std::int32_t alarm_code = 0;                   ///< DriveProfile::alarms has its words
  double watchdog_s = 0;                         ///< the drive's, as read back
  std::uint64_t motion = 0;                      ///< number of the latest; 0: none yet
  std::uint64_t missed_polls = 0, connects = 0;  ///< since the start
  Jitter jitter;                                 ///< `ticks` is the owner's sign of life
};

/// What the owner of the drive tells, without ever waiting, and others copy out.
class RigStatus {
 public:
  static constexpr std::size_t kMotions = 64;

  SampleRing samples;
  Seqlock<Snapshot> snapshot;

  /// By the owner.
  void put(const MotionReport& report) { motions_[report.number % kMotions].store(report); }
  /// The one of that number; none if it is not there yet, or any more.
  [[nodiscard]] std::optional<MotionReport> motion(std::uint64_t number) const {
    const MotionReport report = motions_[number % kMotions].load();
    if (number == 0 || report.number != number) return std::nullopt;
    return report;
  }

  /// By the owner; false if somebody is just reading: then try again later.
  [[nodiscard]] bool put(const std::optional<Error>& trouble) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock) trouble_ = trouble;
    return lock.owns_lock();
  }
  /// Why the drive does not answer, or must not be armed; none: all is well.
  [[nodiscard]] std::optional<Error> trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
  }

 private:
  std::array<Seqlock<MotionReport>, kMotions> motions_;
  mutable std::mutex mutex_;
  std::optional<Error> trouble_;
};

}  // namespace hydroprint::rig
