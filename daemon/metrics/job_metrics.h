#pragma once

#include <prometheus/registry.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <thread>

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

  /// Returns the metrics in Prometheus format. Thread-safe.
  [[nodiscard]] std::string text() const;

 private:
  struct OpenJob {
    std::string kind, stage;
    std::int64_t since_ms = 0;  ///< when the stage began
    bool computed = true;
    std::optional<std::int64_t> start_ms = {};
  };

  void run(std::int64_t seq);
  void take(const JobEvent& event);
  [[nodiscard]] OpenJob& open_job(const JobEvent& event);
  void start(OpenJob& job, std::int64_t time_ms);
  void finish(const OpenJob& job, const JobEvent& event);
  void observe_stage(const OpenJob& job, std::int64_t end_ms);

  JobStore& jobs_;
  prometheus::Registry registry_;
  prometheus::Family<prometheus::Summary>& stages_;
  prometheus::Family<prometheus::Counter>& finished_;
  prometheus::Family<prometheus::Histogram>& queue_waits_;
  prometheus::Family<prometheus::Histogram>& durations_;
  std::map<std::int64_t, OpenJob> open_;  // open_ and stage_count_ are used only by the thread
  int stage_count_ = 0;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

}  // namespace hydroprint::daemon
