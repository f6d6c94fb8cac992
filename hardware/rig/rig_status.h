#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>

#include "hardware/drive/link_statistics.h"
#include "hardware/rig/samples.h"
#include "hardware/rig/state.h"
#include "sim/base/process/real_time_thread.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// The report of one motion.
struct MotionReport {
  enum class Outcome : std::uint8_t {
    kRunning,
    kDone,
    kStopped,  ///< on request, or because the jog was not requested again
    kFailed,   ///< failed; `cause` is the reason
  };
  std::uint64_t number = 0;
  Motion motion = Motion::kNone;
  Outcome outcome = Outcome::kRunning;
  Cause cause = Cause::kNone;
  std::int32_t alarm_code = 0;  ///< alarm of the drive, if the motion failed; 0: none
  bool at_rest = false;         ///< standstill was observed after the end
  double begin_mm = 0;
  double end_mm = 0;  ///< last observed position
  TimePoint begun, ended;
  TimePoint rested;                ///< time of standstill
  std::uint64_t first_sample = 0;  ///< number, in the SampleRing, of the first sample of the motion
  std::uint64_t last_sample = 0;   ///< number of its latest sample; finally that at standstill
};

/// Timing statistics of the control loop's polls.
struct Jitter {
  std::uint64_t ticks = 0;
  std::uint64_t skipped = 0;  ///< periods skipped because the previous one took longer
  std::uint64_t late = 0;     ///< polls that began more than half a period late
  double largest_s = 0;       ///< largest delay of a poll
  double rms_s = 0;           ///< rms delay of the polls
};

/// The complete state of the rig at one point in time.
struct Snapshot {
  Condition condition;
  TimePoint time;         ///< time of the last valid poll
  bool has_axis = false;  ///< the next four fields are valid; false while the link is lost
  Bits bits;
  double position_mm = 0;
  double velocity_mm_per_s = 0;
  std::int32_t alarm_code = 0;                   ///< text in DriveProfile::alarms
  double watchdog_s = 0;                         ///< watchdog time of the drive, as read back
  std::uint64_t motion = 0;                      ///< number of the latest motion; 0: none yet
  std::uint64_t missed_polls = 0, connects = 0;  ///< since the start
  drive::LinkStatistics link;  ///< how the drive's replies arrive, except those to StopChannel
  Jitter jitter;               ///< increasing Jitter::ticks show that the control loop runs
  /// What the system has granted to the control loop. `memory_locked` covers its stack, its state
  /// and the samples.
  ThreadPriority priority;
};

/// Data that the control loop publishes without waiting and other threads copy.
class RigStatus {
 public:
  static constexpr std::size_t kMotions = 64;

  SampleRing samples;
  Seqlock<Snapshot> snapshot;

  /// Publishes a report; only the control loop may call this.
  void put(const MotionReport& report) { motions_[report.number % kMotions].store(report); }
  /// Returns the report of a motion; nullopt if it does not exist yet or has been overwritten.
  [[nodiscard]] std::optional<MotionReport> motion(std::uint64_t number) const {
    const MotionReport report = motions_[number % kMotions].load();
    if (number == 0 || report.number != number) return std::nullopt;
    return report;
  }

  /// Publishes the current fault; only the control loop may call this. Returns false, without
  /// effect, while another thread reads the fault; call it again later.
  [[nodiscard]] bool put(const std::optional<Error>& trouble) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock) trouble_ = trouble;
    return lock.owns_lock();
  }
  /// Returns why the drive does not respond, or must not be armed; nullopt: no fault.
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
