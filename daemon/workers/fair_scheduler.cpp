#include "daemon/workers/fair_scheduler.h"

#include <algorithm>
#include <deque>
#include <tuple>

namespace hydroprint::daemon {

std::vector<std::int64_t> FairScheduler::order(const std::vector<WaitingJob>& waiting,
                                               std::map<std::string, int> running,
                                               std::size_t limit) const {
  std::map<std::string, std::deque<WaitingJob>> queues;
  for (const WaitingJob& job : waiting) queues[job.owner].push_back(job);
  for (auto& [owner, jobs] : queues) {
    std::sort(jobs.begin(), jobs.end(), [](const WaitingJob& a, const WaitingJob& b) {
      return std::tuple(-a.priority, a.rank) < std::tuple(-b.priority, b.rank);
    });
  }
  auto last_turn = last_turn_;
  std::uint64_t turn = turn_;
  std::vector<std::int64_t> ids;
  while (!queues.empty() && ids.size() < limit) {
    const auto next = std::min_element(queues.begin(), queues.end(), [&](auto& a, auto& b) {
      const auto key = [&](auto& queue) {
        return std::tuple(running[queue.first], last_turn[queue.first], queue.second.front().rank);
      };
      return key(a) < key(b);
    });
    ids.push_back(next->second.front().id);
    ++running[next->first];
    last_turn[next->first] = ++turn;
    next->second.pop_front();
    if (next->second.empty()) queues.erase(next);
  }
  return ids;
}

}  // namespace hydroprint::daemon
