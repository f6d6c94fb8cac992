#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "daemon/dip/session.h"
#include "daemon/jobs/executor.h"

namespace hydroprint::daemon {

/// Carries out dips, one at a time, in a thread of its own. Any thread may call.
class DipExecutor final : public JobExecutor {
 public:
  /// @param surroundings  outlive it
  explicit DipExecutor(const DipSurroundings& surroundings);
  /// Stops if stop() was not called.
  ~DipExecutor() override;

  /// Refuses a caller without the lease, what plan_of() and go_by_calibration() refuse, and what
  /// the rig, as it stands, cannot do: RIG_OFFLINE and the like, as it would refuse a move;
  /// LIMIT_EXCEEDED; STATE_FORBIDS for Clocks::skip unless the drive is a virtual one.
  [[nodiscard]] Result<Job> check(const JobRequest& request) override;
  [[nodiscard]] Result<Job> create(const JobRequest& request) override;
  /// See DipSession::confirm; of a dip that is over, only the steps that were done.
  [[nodiscard]] Result<Job> confirm(std::int64_t job, dip::Step step, const std::string& holder);
  /// Stops the motion of a dip at once and has it end CANCELLED.
  [[nodiscard]] Result<Job> cancel(std::int64_t job) override;
  /// Brings a dip that is open to its end, INTERRUPTED, and the axis to rest; takes as long as that
  /// needs.
  void stop() override;

 private:
  /// What a request asks for, and who has the lease.
  struct Order {
    dip::Plan plan;
    std::string holder;
  };
  [[nodiscard]] Result<Order> order_of(const JobRequest& request) const;
  [[nodiscard]] Status check_rig(const dip::Plan& plan) const;
  void loop();
  void wake();  // needs mutex_

  DipSurroundings around_;
  mutable std::mutex mutex_;
  std::condition_variable woken_;
  bool wake_ = false;
  bool end_ = false;
  std::chrono::steady_clock::time_point end_by_;
  std::unique_ptr<DipSession> run_;
  std::thread thread_;
};

}  // namespace hydroprint::daemon
