// The worker pool at an executor that does not take jobs at all times.
#include "daemon/workers/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>

#include "tests/daemon/store/store_fixture.h"
#include "tests/support/timing.h"

namespace hydroprint::daemon {
namespace {

/// Takes jobs only while `is_open`; they wait there for ever.
class GatedExecutor : public WorkerExecutor {
 public:
  [[nodiscard]] std::string name() const override { return "gated"; }
  [[nodiscard]] bool outlives_daemon() const override { return true; }
  [[nodiscard]] int capacity() const override { return 1; }
  [[nodiscard]] Status ready() override {
    return is_open ? Status() : Status(fail(Code::kResourceExhausted, "the share is full"));
  }
  [[nodiscard]] Result<std::string> start(const Execution&, const Launch&) override { return "h"; }
  [[nodiscard]] Observations poll(const std::vector<Execution>&) override { return {}; }
  [[nodiscard]] Status cancel(const Execution&, CancelHow) override { return {}; }
  [[nodiscard]] Adoption adopt(const Execution&) override { return Adoption::kAdopted; }

  std::atomic<bool> is_open{false};
};

class WorkerPoolTest : public StoreTest {};

TEST_F(WorkerPoolTest, SaysWhyNoJobStartsAndStartsThemByItself) {
  GatedExecutor executor;
  PoolOptions options;
  options.program = "/bin/true";
  const auto pool =
      WorkerPool::make(options, executor, *jobs, *queue, layout, [] { return 0; }).value();
  EXPECT_EQ(pool->blocked_reason(), "");
  const std::int64_t id = add().id;
  pool->start();
  EXPECT_TRUE(testing::wait_until([&] { return pool->blocked_reason() == "the share is full"; }));
  EXPECT_EQ(jobs->get(id)->state, JobState::kQueued);

  executor.is_open = true;
  pool->wake();
  EXPECT_TRUE(testing::wait_until([&] { return jobs->executions()->size() == 1; }));
  EXPECT_TRUE(testing::wait_until([&] { return jobs->executions()->front().handle == "h"; }));
  EXPECT_EQ(pool->blocked_reason(), "");
  pool->stop();
}

}  // namespace
}  // namespace hydroprint::daemon
