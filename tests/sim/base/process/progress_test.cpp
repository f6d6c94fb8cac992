#include "sim/base/process/progress.h"

#include <gtest/gtest.h>

#include <vector>

namespace hydroprint::worker {
namespace {

/// Progress with a clock that the test moves.
struct Bench {
  std::vector<Stage> stages = {{"reading", 1}, {"velocity", 3}};
  double now_s = 100;
  std::vector<ProgressReport> reports = {};
  Progress progress{stages, [this] { return now_s; },
                    [this](const ProgressReport& report) { reports.push_back(report); }};

  void update(double s, const char* stage, double fraction) {
    now_s = 100 + s;
    progress.update(stage, fraction);
  }
};

TEST(Progress, TotalWeighsTheStages) {
  Bench bench;
  bench.update(0, "reading", 0.5);
  bench.update(1, "velocity", 0);
  bench.update(2, "velocity", 0.5);
  ASSERT_EQ(bench.reports.size(), 3u);
  EXPECT_DOUBLE_EQ(bench.reports[0].total_fraction, 0.125);
  EXPECT_DOUBLE_EQ(bench.reports[1].total_fraction, 0.25);
  EXPECT_DOUBLE_EQ(bench.reports[2].total_fraction, 0.625);
  EXPECT_EQ(bench.reports[2].stage, "velocity");
  EXPECT_EQ(bench.reports[2].fraction, 0.5);
}

TEST(Progress, FractionAndTotalNeverDecrease) {
  Bench bench;
  bench.update(0, "velocity", 0.8);
  bench.update(1, "velocity", 0.3);
  bench.update(2, "reading", 0.1);
  bench.update(3, "something else", 7);
  for (std::size_t i = 1; i < bench.reports.size(); ++i) {
    EXPECT_GE(bench.reports[i].total_fraction, bench.reports[i - 1].total_fraction);
  }
  EXPECT_EQ(bench.reports[1].fraction, 0.8);
  EXPECT_EQ(bench.reports[3].fraction, 1);
}

TEST(Progress, RecurringStagesAreMatchedInOrderAndSkippedStagesCountAsDone) {
  Bench bench{{{"reading", 1}, {"flow map", 2}, {"sheet", 3}, {"flow map", 4}}};
  const auto total_at = [&](const char* stage, double fraction) {
    bench.update(0, stage, fraction);
    return bench.reports.back().total_fraction;
  };
  EXPECT_DOUBLE_EQ(total_at("flow map", 0.5), 0.2);
  EXPECT_DOUBLE_EQ(total_at("sheet", 0), 0.3);
  EXPECT_DOUBLE_EQ(total_at("flow map", 0.5), 0.8);
  EXPECT_DOUBLE_EQ(total_at("flow map", 1), 1);
  bench.update(1, "sheet", 0);
  EXPECT_DOUBLE_EQ(bench.reports.back().total_fraction, 1);
}

TEST(Progress, TimeLeftIsProportionalAndNotGuessedTooEarly) {
  Bench bench;
  bench.update(0.01, "reading", 0.5);
  EXPECT_FALSE(bench.reports.back().eta_s);
  bench.update(10, "velocity", 0);
  ASSERT_TRUE(bench.reports.back().eta_s);
  EXPECT_DOUBLE_EQ(*bench.reports.back().eta_s, 30);
}

TEST(Progress, ReportsAtMostTenTimesASecondWithinAStage) {
  Bench bench;
  for (int i = 0; i <= 1000; ++i) bench.update(i / 1000.0, "velocity", i / 1000.0);
  EXPECT_GE(bench.reports.size(), 9u);
  EXPECT_LE(bench.reports.size(), 12u);
}

TEST(Progress, TheEndOfAStageIsReportedExactlyOnce) {
  Bench bench;
  bench.update(0, "velocity", 0);
  for (int i = 1; i < 5; ++i) bench.update(0.01 * i, "velocity", 1);
  ASSERT_EQ(bench.reports.size(), 2u);
  EXPECT_EQ(bench.reports[1].total_fraction, 1);
}

TEST(Progress, SecondsAreSummedPerStageEvenIfItRecurs) {
  Bench bench;
  bench.update(0, "reading", 0);
  bench.update(2, "velocity", 0);
  bench.update(5, "reading", 0);
  bench.now_s = 109;
  const auto seconds = bench.progress.stage_seconds();
  ASSERT_EQ(seconds.size(), 2u);
  EXPECT_EQ(seconds[0].first, "reading");
  EXPECT_DOUBLE_EQ(seconds[0].second, 6);
  EXPECT_DOUBLE_EQ(seconds[1].second, 3);
  EXPECT_DOUBLE_EQ(bench.progress.total_s(), 9);
}

}  // namespace
}  // namespace hydroprint::worker
