#include "daemon/workers/fair_scheduler.h"

#include <gtest/gtest.h>

namespace hydroprint::daemon {
namespace {

using Ids = std::vector<std::int64_t>;

TEST(FairScheduler, OwnersAlternateRegardlessOfTheirJobs) {
  const std::vector<WaitingJob> waiting{
      {1, "ann", 0, 1}, {2, "ann", 0, 2}, {3, "ann", 0, 3}, {4, "bob", 0, 4}, {5, "bob", 0, 5}};
  EXPECT_EQ(FairScheduler().order(waiting, {}, 10), (Ids{1, 4, 2, 5, 3}));
}

TEST(FairScheduler, PriorityThenAgeApplyOnlyWithinAnOwner) {
  const std::vector<WaitingJob> waiting{
      {1, "ann", 0, 1}, {2, "bob", 0, 2}, {3, "bob", 9, 3}, {4, "bob", 9, 4}};
  EXPECT_EQ(FairScheduler().order(waiting, {}, 10), (Ids{1, 3, 4, 2}));
}

TEST(FairScheduler, LastServedOwnerWaits) {
  FairScheduler turns;
  turns.served("ann");
  const std::vector<WaitingJob> waiting{{1, "ann", 0, 1}, {2, "bob", 0, 2}};
  EXPECT_EQ(turns.order(waiting, {}, 1), Ids{2});
  turns.served("bob");
  EXPECT_EQ(turns.order(waiting, {}, 1), Ids{1});
}

TEST(FairScheduler, OwnerWithFewerRunningJobsIsFirst) {
  const std::vector<WaitingJob> waiting{{1, "ann", 0, 1}, {2, "bob", 0, 2}};
  EXPECT_EQ(FairScheduler().order(waiting, {{"ann", 2}, {"bob", 1}}, 10), (Ids{2, 1}));
}

}  // namespace
}  // namespace hydroprint::daemon
