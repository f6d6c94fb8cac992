#include "daemon/workers/slurm/queue.h"

#include <gtest/gtest.h>

namespace hydroprint::daemon::slurm {
namespace {

TEST(SlurmQueue, JobsOfDaemonsAreKept) {
  const auto queue = parse_queue(
      "11|PENDING|Resources|hydroprint-lab-7-1\n"
      "12|RUNNING|None|hydroprint-lab-8-2\n"
      "13|TIMEOUT|TimeLimit|hydroprint-lab-9-1\n"
      "14|RUNNING|None|hydroprint-other-7-1\n"
      "15_[1-4%2]|PENDING|Priority|an array | with bars\n");
  ASSERT_TRUE(queue);
  ASSERT_EQ(queue->size(), 4U);
  EXPECT_EQ(queue->at(job_name("/shared/lab/7-1")).phase, Phase::kWaits);
  EXPECT_EQ(queue->at(job_name("/shared/lab/7-1")).reason, "Resources");
  EXPECT_EQ(queue->at(job_name("/shared/lab/8-2")).phase, Phase::kRuns);
  EXPECT_EQ(queue->at(job_name("/shared/lab/9-1")).phase, Phase::kEnded);
  EXPECT_EQ(queue->at(job_name("/shared/lab/9-1")).state, "TIMEOUT");
}

TEST(SlurmQueue, EmptyAnswerMeansNoJobs) {
  const auto queue = parse_queue("");
  ASSERT_TRUE(queue);
  EXPECT_TRUE(queue->empty());
}

TEST(SlurmQueue, OfJobsWithOneNameTheOneThatRunsCounts) {
  const std::string name = "hydroprint-lab-1-1\n";
  for (const std::string& text :
       {"1|RUNNING|None|" + name + "2|COMPLETED|None|" + name + "3|PENDING|None|" + name,
        "1|PENDING|None|" + name + "2|FAILED|None|" + name + "3|COMPLETING|None|" + name}) {
    EXPECT_EQ(parse_queue(text)->at(job_name("/shared/lab/1-1")).phase, Phase::kRuns) << text;
  }
  EXPECT_EQ(parse_queue("1|FAILED|None|" + name + "2|CANCELLED|None|" + name)
                ->at(job_name("/shared/lab/1-1"))
                .state,
            "CANCELLED");
}

TEST(SlurmQueue, UnknownStateRuns) {
  const auto queue = parse_queue("1|TELEPORTING|None|hydroprint-lab-1-1\n");
  EXPECT_EQ(queue->at(job_name("/shared/lab/1-1")).phase, Phase::kRuns);
}

TEST(SlurmQueue, AnythingElseIsNoAnswer) {
  for (const char* text :
       {"hello\n", "1|RUNNING|None|hydroprint-lab-1-1", "\n", "slurm_load_jobs error: Unable\n",
        "1|RUNNING|None\n", "x|RUNNING|None|hydroprint-lab-1-1\n", "1||None|hydroprint-lab-1-1\n",
        "1|RUNNING|None|hydroprint-lab-1-1\n{\"jobs\":\n"}) {
    EXPECT_FALSE(parse_queue(text)) << text;
  }
}

}  // namespace
}  // namespace hydroprint::daemon::slurm
