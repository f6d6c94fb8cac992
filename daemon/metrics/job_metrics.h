#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "daemon/platform/prometheus_text.h"
#include "daemon/store/job_store.h"

namespace hydroprint::daemon {

/// Measures how long jobs stay in each stage and how they end, since the daemon started. Follows
/// job events in its own thread, because PROGRESS events are deleted when a job ends.
class JobMetrics {
 public:
  /// @param jobs  must outlive this object
  explicit JobMetrics(JobStore& jobs);
  ~JobMetrics();
  JobMetrics(const JobMetrics&) = delete;
  JobMetrics& operator=(const JobMetrics&) = delete;

  void describe(PrometheusText& out) const;

 private:
  struct Seen {
    std::string kind, stage;
    std::int64_t since_ms = 0;
    bool computed = true;
  };
  struct Spent {
    double sum_s = 0;
    std::uint64_t count = 0;
  };

  void run();
  void take(const JobEvent& event);
  [[nodiscard]] Seen seen_of(const JobEvent& event);
  void spend(const Seen& seen, std::int64_t until_ms);

  JobStore& jobs_;
  mutable std::mutex mutex_;
  std::map<std::int64_t, Seen> open_;
  std::map<std::pair<std::string, std::string>, Spent> spent_;          // keyed by kind and stage
  std::map<std::pair<std::string, std::string>, std::uint64_t> ended_;  // keyed by kind and outcome
  std::atomic<bool> end_{false};
  std::thread thread_;
};

}  // namespace hydroprint::daemon
