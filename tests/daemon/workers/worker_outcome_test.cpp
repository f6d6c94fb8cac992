#include "daemon/workers/worker_outcome.h"

#include <gtest/gtest.h>
#include <signal.h>

namespace hydroprint::daemon {
namespace {

int exited(int status) { return status << 8; }

std::string reason(int wait_status, const char* words = "",
                   StopReason stopped = StopReason::kNothing) {
  return judge(wait_status, stopped, words)->error.reason;
}

TEST(Outcome, ExitZeroIsSuccess) { EXPECT_FALSE(judge(0, StopReason::kNothing, "warning: x\n")); }

TEST(Outcome, RefusedInputHasTheWorkersLastLine) {
  const auto failure = judge(exited(3), StopReason::kNothing, "note\nspot.obj:7: NaN; fix it\n\n");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->error.code, Code::kInvalidArgument);
  EXPECT_EQ(failure->error.reason, "INPUT_REFUSED");
  EXPECT_EQ(failure->error.message, "spot.obj:7: NaN; fix it");
  EXPECT_EQ(failure->exit_status, 3);
  EXPECT_FALSE(failure->signal);
}

TEST(Outcome, PrintedReasonIsUsedIfKnown) {
  const auto told = [](int status, const std::string& answer) {
    return judge(status, StopReason::kNothing, "words", answer)->error.reason;
  };
  EXPECT_EQ(told(exited(3), R"({"error":{"reason":"MIRRORED","metadata":{}}})"
                            "\n"),
            "MIRRORED");
  EXPECT_EQ(told(exited(4), R"({"error":{"reason":"CAMERA_GONE"}})"), "CAMERA_GONE");
  EXPECT_EQ(told(exited(3), R"({"error":{"reason":"MIRRORED","message":"frames[1]"}})"),
            "MIRRORED");
  EXPECT_EQ(told(exited(3), R"({"error":{"reason":"MADE_UP"}})"), "INPUT_REFUSED");
  EXPECT_EQ(told(exited(3), R"({"error":"reason"})"), "INPUT_REFUSED");
  EXPECT_EQ(told(exited(3), std::string(100000, '{')), "INPUT_REFUSED");
  EXPECT_EQ(told(SIGSEGV, R"({"error":{"reason":"MIRRORED"}})"), "WORKER_KILLED");
}

TEST(Outcome, MessageAndFieldAreThoseOfTheWorkersError) {
  const auto failure = judge(exited(3), StopReason::kNothing, "hydroprint-worker: dpi: too large\n",
                             R"({"error":{"message":"too large","metadata":{"field":"dpi"}}})");
  EXPECT_EQ(failure->error.message, "too large");
  EXPECT_EQ(failure->error.metadata.at("field"), "dpi");
  const auto silent =
      judge(exited(3), StopReason::kNothing, "hydroprint-worker: dpi: too large\n", "{");
  EXPECT_EQ(silent->error.message, "dpi: too large") << "without the program's name";
  EXPECT_TRUE(silent->error.metadata.empty());
}

TEST(Outcome, EachKindOfEndHasItsReason) {
  EXPECT_EQ(reason(exited(2)), "INPUT_REFUSED");
  EXPECT_EQ(reason(exited(4), "it failed"), "COMPUTATION_FAILED");
  EXPECT_EQ(reason(exited(127)), "WORKER_UNUSABLE");
  EXPECT_EQ(reason(exited(1)), "COMPUTATION_FAILED");
  EXPECT_EQ(reason(SIGSEGV), "WORKER_KILLED");
  EXPECT_EQ(reason(SIGKILL), "WORKER_KILLED");
  EXPECT_EQ(reason(SIGXCPU), "TIME_LIMIT");
  EXPECT_EQ(reason(SIGXFSZ), "OUTPUT_LIMIT");
  EXPECT_EQ(reason(SIGKILL, "", StopReason::kTime), "TIME_LIMIT");
  EXPECT_EQ(reason(SIGKILL, "", StopReason::kMemory), "MEMORY_LIMIT");
}

TEST(Outcome, LimitsAreToldByReasonCodesAndNotByWords) {
  const auto told = [](const std::string& reason) {
    return judge(exited(4), StopReason::kNothing, "words",
                 R"({"error":{"reason":")" + reason + "\"}}")
        ->error;
  };
  EXPECT_EQ(told("OUT_OF_MEMORY").reason, "MEMORY_LIMIT");
  EXPECT_EQ(told("DISK_FULL").reason, "DISK_FULL");
  EXPECT_EQ(told("FILE_LIMIT").reason, "OUTPUT_LIMIT");
  EXPECT_EQ(told("DISK_FULL").code, Code::kResourceExhausted);
  EXPECT_EQ(reason(exited(4), "out of memory, the disk is full"), "COMPUTATION_FAILED");
}

TEST(Outcome, OutputBecomesOnePrintableLine) {
  EXPECT_EQ(last_line("a\nb\x01\x1b[2J\xff\n  \n"), "b??[2J?");
  EXPECT_EQ(last_line("gr\xc3\xb6\xc3\x9f"
                      "e \xe2\x82\xac"),
            "gr\xc3\xb6\xc3\x9f"
            "e \xe2\x82\xac");
  EXPECT_EQ(last_line("\n \n"), "");
  EXPECT_LE(last_line(std::string(5000, 'x')).size(), 1000U);
}

TEST(Progress, LineIsParsed) {
  const auto progress = read_progress(
      R"({"stage":"flow map","fraction":0.5,"total_fraction":0.25,"eta_s":3.5})", 1000);
  ASSERT_TRUE(progress);
  EXPECT_EQ(progress->phase, "flow map");
  EXPECT_EQ(progress->phase_fraction, 0.5);
  EXPECT_EQ(progress->fraction, 0.25);
  EXPECT_EQ(progress->eta_ms, 4500);
}

TEST(Progress, HostileLinesAreIgnoredOrClamped) {
  for (const char* bad :
       {"", "{", "[]", "7", "{\"stage\":7,\"total_fraction\":1}", "{\"stage\":\"x\"}",
        "{\"stage\":\"x\",\"total_fraction\":\"1\"}", "{\"stage\":\"x\",\"total_fraction\":NaN}"}) {
    EXPECT_FALSE(read_progress(bad, 0)) << bad;
  }
  EXPECT_FALSE(read_progress(std::string(1000000, '['), 0));
  EXPECT_FALSE(read_progress("{\"a\":" + std::string(100000, '{'), 0));
  const auto wild =
      read_progress(R"({"stage":"a\u0007b","fraction":-3,"total_fraction":9,"eta_s":1e300})", 0);
  ASSERT_TRUE(wild);
  EXPECT_EQ(wild->phase, "a?b");
  EXPECT_EQ(wild->phase_fraction, 0);
  EXPECT_EQ(wild->fraction, 1);
  EXPECT_EQ(wild->eta_ms, 0);
}

}  // namespace
}  // namespace hydroprint::daemon
