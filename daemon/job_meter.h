#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "daemon/exposition.h"
#include "daemon/job_store.h"

namespace hydroprint::daemon {

/// Measures what becomes of jobs, from its start on: how long they are in which stage, and how they
/// end. Follows their events in a thread of its own, since PROGRESS is not kept after a job's end.
class JobMeter {
 public:
  /// @param jobs  outlives it
  explicit JobMeter(JobStore& jobs);
  ~JobMeter();
  JobMeter(const JobMeter&) = delete;
  JobMeter& operator=(const JobMeter&) = delete;

  void describe(Exposition& out) const;
  /// When the camera's latest frames came to be, as far as is known; Unix time in ms, 0: it is not.
  [[nodiscard]] std::int64_t camera_ms() const;

 private:
  struct Seen {
    std::string kind, stage;
    std::int64_t since_ms = 0;
  };
  struct Spent {
    double sum_s = 0;
    std::uint64_t count = 0;
  };

  void run();
  void take(const JobEvent& event);
  void spend(const Seen& seen, std::int64_t until_ms);

  JobStore& jobs_;
  mutable std::mutex mutex_;
  std::map<std::int64_t, Seen> open_;
  std::map<std::pair<std::string, std::string>, Spent> spent_;          // by kind and stage
  std::map<std::pair<std::string, std::string>, std::uint64_t> ended_;  // by kind and outcome
  std::int64_t camera_ms_ = 0;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

}  // namespace hydroprint::daemon
