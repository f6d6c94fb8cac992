#include "sim/base/result.h"

#include <gtest/gtest.h>

namespace hydroprint {
namespace {

ExitStatus status_of(Code code) { return exit_status(Error{code, "x", {}, {}}); }

TEST(ExitStatus, CancelledIs130) {
  EXPECT_EQ(status_of(Code::kCancelled), ExitStatus::kCancelled);
  EXPECT_EQ(static_cast<int>(ExitStatus::kCancelled), 130);
}

TEST(ExitStatus, UnimplementedIsBadUsage) {
  EXPECT_EQ(static_cast<int>(status_of(Code::kUnimplemented)), 2);
}

TEST(ExitStatus, InputThatTheUserCanCorrectIsBadInput) {
  for (const Code code : {Code::kInvalidArgument, Code::kNotFound, Code::kAlreadyExists,
                          Code::kPermissionDenied, Code::kFailedPrecondition, Code::kOutOfRange,
                          Code::kResourceExhausted, Code::kDataLoss, Code::kUnauthenticated}) {
    EXPECT_EQ(static_cast<int>(status_of(code)), 3) << static_cast<int>(code);
  }
}

TEST(ExitStatus, InternalErrorsAreFailed) {
  for (const Code code : {Code::kInternal, Code::kUnavailable, Code::kAborted}) {
    EXPECT_EQ(static_cast<int>(status_of(code)), 4) << static_cast<int>(code);
  }
}

TEST(ExitStatus, AFullDiskIsBadInputAndFullMemoryIsFailed) {
  EXPECT_EQ(exit_status({Code::kResourceExhausted, "x", ErrorReason::DISK_FULL, {}}),
            ExitStatus::kBadInput);
  EXPECT_EQ(exit_status({Code::kResourceExhausted, "x", ErrorReason::MEMORY_LIMIT, {}}),
            ExitStatus::kFailed);
}

Result<int> half(int value) {
  if (value % 2 != 0) return fail(Code::kInvalidArgument, "odd", ErrorReason::SPEC_INVALID);
  return value / 2;
}

Result<int> quarter(int value) {
  HP_ASSIGN_OR_RETURN(const int once, half(value));
  HP_RETURN_IF_ERROR(half(once));
  return half(once);
}

TEST(Result, MacrosPassErrorsOnUnchanged) {
  EXPECT_EQ(quarter(8).value(), 2);
  for (const int value : {3, 6}) {
    const auto result = quarter(value);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, Code::kInvalidArgument);
    EXPECT_EQ(result.error().message, "odd");
    EXPECT_EQ(result.error().reason, ErrorReason::SPEC_INVALID);
  }
}

}  // namespace
}  // namespace hydroprint
