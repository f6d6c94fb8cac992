#include "hardware/rig/errors.h"

#include <gtest/gtest.h>

#include <set>

#include "hardware/rig/state_names.h"

namespace hydroprint::rig {
namespace {

TEST(Errors, EveryCauseHasANameAReasonAndARemedy) {
  std::set<std::string_view> names;
  for (int i = 1; i <= static_cast<int>(Cause::kStopButton); ++i) {
    const auto cause = static_cast<Cause>(i);
    EXPECT_TRUE(names.insert(name(cause)).second);
    const Error error = failed(cause);
    EXPECT_NE(error.reason, ErrorReason{});
    EXPECT_EQ(error.metadata.at("cause"), name(cause));
    EXPECT_NE(error.message.find("then reset, arm and home"), std::string::npos);
  }
}

TEST(Errors, TheStopButtonHasItsOwnReason) {
  EXPECT_EQ(failed(Cause::kStopButton).reason, ErrorReason::STOP_BUTTON);
}

TEST(Errors, NoRefusalIsRetriedAutomatically) {
  for (int i = 0; i <= static_cast<int>(Refusal::kConfigUnsafe); ++i) {
    const auto refusal = static_cast<Refusal>(i);
    const Error error = refused(refusal, {State::kFault, Motion::kNone, Cause::kAlarm});
    EXPECT_NE(error.code, Code::kUnavailable);
    EXPECT_EQ(error.reason, reason(refusal));
    EXPECT_EQ(error.metadata.at("state"), "FAULT");
    EXPECT_EQ(error.metadata.at("cause"), "DRIVE_ALARM");
  }
  for (int i = 1; i <= static_cast<int>(Cause::kStopButton); ++i) {
    EXPECT_NE(failed(static_cast<Cause>(i)).code, Code::kUnavailable);
  }
}

TEST(Errors, AFaultIsDescribed) {
  const Error error =
      refused(Refusal::kFaulted, {State::kFault, Motion::kNone, Cause::kFollowingError});
  EXPECT_NE(error.message.find("not at its commanded position"), std::string::npos)
      << error.message;
}

}  // namespace
}  // namespace hydroprint::rig
