#include "client/job.h"

#include <google/protobuf/util/time_util.h>
#include <gtest/gtest.h>

#include "client/dip.h"
#include "client/name_of.h"
#include "client/time.h"
#include "hydroprint/v1/rig.pb.h"

namespace hydroprint::client {
namespace {

using google::protobuf::util::TimeUtil;

v1::Job interrupted() {
  v1::Job job;
  job.set_state(v1::Job::INTERRUPTED);
  return job;
}

TEST(Jobs, AnInterruptedDipPrintOrCaptureIsFinishedButAComputationIsNot) {
  v1::Job job = interrupted();
  job.mutable_simulate();
  EXPECT_FALSE(is_finished(job));
  job.mutable_dip();
  EXPECT_TRUE(is_finished(job));
  job.mutable_print();
  EXPECT_TRUE(is_finished(job));
  job.mutable_capture();
  EXPECT_TRUE(is_finished(job)) << "a capture cannot be repeated";
}

TEST(Jobs, StatesOfANewerDaemonAreUnknown) {
  EXPECT_EQ(name_of(v1::Rig::IDLE), "IDLE");
  EXPECT_EQ(name_of(v1::Rig::STATE_UNSPECIFIED), "UNKNOWN");
  EXPECT_EQ(name_of(static_cast<v1::Rig::State>(99)), "UNKNOWN");
}

TEST(Jobs, TheOperatorConfirmsSixSteps) {
  EXPECT_EQ(operator_steps().size(), 6U);
  for (const std::string& name : operator_steps()) {
    v1::DipStatus::Step step{};
    ASSERT_TRUE(v1::DipStatus::Step_Parse(name, &step)) << name;
    EXPECT_TRUE(waits_for_operator(step)) << name;
  }
  EXPECT_FALSE(waits_for_operator(v1::DipStatus::SOAK));
  EXPECT_FALSE(waits_for_operator(v1::DipStatus::STEP_UNSPECIFIED));
}

TEST(Jobs, AnUnsetTimeIsNotATime) {
  v1::Job job;
  EXPECT_FALSE(time_of(job.end_time()));
  *job.mutable_end_time() = TimeUtil::MillisecondsToTimestamp(1234);
  EXPECT_EQ(time_of(job.end_time())->time_since_epoch(), std::chrono::milliseconds(1234));
}

}  // namespace
}  // namespace hydroprint::client
