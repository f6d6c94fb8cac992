#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "daemon/dip_run.h"

namespace hydroprint::daemon {

/// Carries out dips, one at a time, in a thread of its own. Any thread may call.
class DipRunner {
 public:
  /// @param surroundings  outlive it
  explicit DipRunner(const DipSurroundings& surroundings);
  /// Stops if stop() was not called.
  ~DipRunner();
  DipRunner(const DipRunner&) = delete;
  DipRunner& operator=(const DipRunner&) = delete;

  /// Refuses what the rig, as it stands, cannot do: RIG_OFFLINE and the like, as it would refuse a
  /// move; LIMIT_EXCEEDED; STATE_FORBIDS for Clocks::skip unless the drive is a virtual one.
  [[nodiscard]] Status check(const dip::Plan& plan) const;
  /// Stores a dip and begins it. Refuses what check() and JobStore::create() refuse.
  /// @param holder  who has the lease
  [[nodiscard]] Result<Job> create(NewJob made, const RequestKey& request, const dip::Plan& plan,
                                   const std::string& holder);
  /// See DipRun::confirm; of a dip that is over, only the steps that were done.
  [[nodiscard]] Result<Job> confirm(std::int64_t job, dip::Step step, const std::string& holder);
  /// Stops the motion of a dip at once and has it end CANCELLED.
  [[nodiscard]] Result<Job> cancel(std::int64_t job);

  /// Brings a dip that is open to its end, INTERRUPTED; takes as long as the axis needs to come to
  /// rest.
  void stop();

 private:
  void loop();
  void wake();  // needs mutex_

  DipSurroundings around_;
  mutable std::mutex mutex_;
  std::condition_variable woken_;
  bool wake_ = false;
  bool end_ = false;
  std::chrono::steady_clock::time_point end_by_;
  std::unique_ptr<DipRun> run_;
  std::thread thread_;
};

}  // namespace hydroprint::daemon
