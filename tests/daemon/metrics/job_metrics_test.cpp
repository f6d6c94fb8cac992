#include "daemon/metrics/job_metrics.h"

#include <chrono>
#include <thread>

#include "tests/daemon/store/store_fixture.h"

namespace hydroprint::daemon {
namespace {

class JobMetricsTest : public StoreTest {
 protected:
  [[nodiscard]] bool has(const std::string& line) const {
    return metrics.text().find("\n" + line + "\n") != std::string::npos;
  }
  /// Waits until the metrics contain this line; false after 10 s.
  [[nodiscard]] bool comes(const std::string& line) const {
    for (int i = 0; i < 1000 && !has(line); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return has(line);
  }

  JobMetrics metrics{*jobs};
};

TEST_F(JobMetricsTest, QueueWaitAndDurationAreHistograms) {
  const std::int64_t id = add().id;
  now_ms += 3000;
  ASSERT_TRUE(jobs->start(id));
  now_ms += 45'500;
  ASSERT_TRUE(jobs->succeed(id, {}));
  const std::string labels = "{kind=\"simulate\",outcome=\"SUCCEEDED\"";
  EXPECT_TRUE(comes("hydroprint_job_duration_seconds_sum" + labels + "} 45.5"));
  EXPECT_TRUE(has("hydroprint_job_duration_seconds_bucket" + labels + ",le=\"30\"} 0"));
  EXPECT_TRUE(has("hydroprint_job_duration_seconds_bucket" + labels + ",le=\"60\"} 1"));
  EXPECT_TRUE(has("hydroprint_job_queue_wait_seconds_sum{kind=\"simulate\"} 3"));
  EXPECT_TRUE(has("hydroprint_job_queue_wait_seconds_bucket{kind=\"simulate\",le=\"2\"} 0"));
  EXPECT_TRUE(has("hydroprint_job_queue_wait_seconds_bucket{kind=\"simulate\",le=\"5\"} 1"));
  EXPECT_TRUE(has("hydroprint_job_stage_seconds_sum{kind=\"simulate\",stage=\"QUEUED\"} 3"));
}

TEST_F(JobMetricsTest, JobCancelledInTheQueueHasNoDuration) {
  ASSERT_TRUE(jobs->cancel(add().id));
  EXPECT_TRUE(comes("hydroprint_jobs_finished_total{kind=\"simulate\",outcome=\"CANCELLED\"} 1"));
  EXPECT_EQ(metrics.text().find("hydroprint_job_duration_seconds"), std::string::npos);
  EXPECT_EQ(metrics.text().find("hydroprint_job_queue_wait_seconds"), std::string::npos);
}

TEST_F(JobMetricsTest, StagesBeyondTheLimitCountAsOther) {
  const std::int64_t id = add().id;
  ASSERT_TRUE(jobs->start(id));
  for (int stage = 0; stage < 310; ++stage) {
    ASSERT_TRUE(jobs->report(id, {0.5, "stage " + std::to_string(stage), 0.5, 0}));
  }
  ASSERT_TRUE(jobs->cancel(id));
  // The limit is 300 names: QUEUED, starting, and the first 298 stages of the worker.
  EXPECT_TRUE(comes("hydroprint_job_stage_seconds_count{kind=\"simulate\",stage=\"other\"} 12"));
  EXPECT_TRUE(has("hydroprint_job_stage_seconds_count{kind=\"simulate\",stage=\"stage 297\"} 1"));
  EXPECT_EQ(metrics.text().find("stage=\"stage 298\""), std::string::npos);
}

}  // namespace
}  // namespace hydroprint::daemon
