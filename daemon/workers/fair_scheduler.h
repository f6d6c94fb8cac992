#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "daemon/store/job_store.h"

namespace hydroprint::daemon {

/// Owners take turns: the one with the fewest running jobs goes next, then the one served longest
/// ago, then the one whose job came first; within an owner higher priority, then lower rank.
class FairScheduler {
 public:
  /// Notes that a job of this owner was started.
  void served(const std::string& owner) { last_turn_[owner] = ++turn_; }

  /// Ids in the order in which they will start if nothing changes; at most `limit`.
  /// @param running  running jobs by owner
  [[nodiscard]] std::vector<std::int64_t> order(const std::vector<WaitingJob>& waiting,
                                                std::map<std::string, int> running,
                                                std::size_t limit) const;

 private:
  std::uint64_t turn_ = 0;
  std::map<std::string, std::uint64_t> last_turn_;
};

}  // namespace hydroprint::daemon
