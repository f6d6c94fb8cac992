#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/store/job_queue.h"

namespace hydroprint::daemon {

/// Schedules jobs fairly among owners. The next owner is the one with the fewest running jobs;
/// among equals the one served longest ago, then the one whose next job has the lowest rank. Of one
/// owner's jobs, those with a higher priority come first, then those with a lower rank.
class FairScheduler {
 public:
  /// Records that a job of this owner was started.
  void served(const std::string& owner) { last_turn_[owner] = ++turn_; }

  /// Returns ids in the order in which the jobs would start now; at most `limit`.
  /// @param running  number of running jobs by owner
  [[nodiscard]] std::vector<std::int64_t> order(const std::vector<WaitingJob>& waiting,
                                                std::map<std::string, int> running,
                                                std::size_t limit) const;

 private:
  std::uint64_t turn_ = 0;
  std::map<std::string, std::uint64_t> last_turn_;
};

}  // namespace hydroprint::daemon
