#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "daemon/dip/session.h"
#include "daemon/jobs/executor.h"

namespace hydroprint::daemon {

/// Carries out dips, one at a time, in its own thread. Thread-safe.
class DipExecutor final : public JobExecutor {
 public:
  /// @param dependencies  must outlive this object
  explicit DipExecutor(const DipDependencies& dependencies);
  /// Calls stop() if needed.
  ~DipExecutor() override;

  /// Checks a dip. Returns an error for a caller without the lease, and the errors of plan_of() and
  /// go_by_calibration(). Also returns an error if the rig cannot start a dip now: RIG_OFFLINE and
  /// other refusals of a move; LIMIT_EXCEEDED; STATE_FORBIDS for Clocks::skip unless the drive is
  /// virtual.
  [[nodiscard]] Result<Job> check(const JobRequest& request) override;
  [[nodiscard]] Result<Job> create(const JobRequest& request) override;
  /// See DipSession::confirm. After the end of a dip, completed steps can still be confirmed again,
  /// which changes nothing.
  [[nodiscard]] Result<Job> confirm(std::int64_t job, dip::Step step, const std::string& holder);
  /// Stops the motion of a dip immediately; the dip ends as CANCELLED.
  [[nodiscard]] Result<Job> cancel(std::int64_t job) override;
  /// Ends an open dip as INTERRUPTED and waits until the axis is at rest.
  void stop() override;

 private:
  /// The plan of a dip, and the holder of the lease.
  struct Order {
    dip::Plan plan;
    std::string holder;
  };
  [[nodiscard]] Result<Order> order_of(const JobRequest& request) const;
  [[nodiscard]] Status check_rig(const dip::Plan& plan) const;
  void loop();
  void wake();  // the caller must hold mutex_

  DipDependencies dependencies_;
  mutable std::mutex mutex_;
  std::condition_variable woken_;
  bool wake_ = false;
  bool end_ = false;
  std::chrono::steady_clock::time_point end_by_;
  std::unique_ptr<DipSession> run_;
  std::thread thread_;
};

}  // namespace hydroprint::daemon
