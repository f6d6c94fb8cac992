#include "daemon/workers/worker_outcome.h"

#include <gtest/gtest.h>
#include <signal.h>

namespace hydroprint::daemon {
namespace {

int exited(int status) { return status << 8; }

ErrorReason reason(int wait_status, const char* words = "",
                   StopReason stopped = StopReason::kNothing) {
  return judge(wait_status, stopped, words)->error.reason;
}

TEST(Outcome, ExitZeroIsSuccess) { EXPECT_FALSE(judge(0, StopReason::kNothing, "warning: x\n")); }

TEST(Outcome, RefusedInputHasTheWorkersMessage) {
  const auto failure =
      judge(exited(3), StopReason::kNothing, "for people\n",
            "a line\n"
            R"({"error": {"message": "spot.obj:7: NaN; fix it", "exit_status": 3}})"
            "\n\n");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->error.code, Code::kInvalidArgument);
  EXPECT_EQ(failure->error.reason, ErrorReason::INPUT_REFUSED);
  EXPECT_EQ(failure->error.message, "spot.obj:7: NaN; fix it");
  EXPECT_EQ(failure->exit_status, 3);
  EXPECT_FALSE(failure->signal);
}

TEST(Outcome, PrintedReasonIsUsedIfKnown) {
  const auto told = [](int status, const std::string& answer) {
    return judge(status, StopReason::kNothing, "words", answer)->error.reason;
  };
  EXPECT_EQ(told(exited(3), R"({"error":{"reason":"MIRRORED"}})"
                            "\n"),
            ErrorReason::MIRRORED);
  EXPECT_EQ(told(exited(4), R"({"error":{"reason":"CAMERA_GONE"}})"), ErrorReason::CAMERA_GONE);
  EXPECT_EQ(told(exited(3), R"({"error":{"reason":"MIRRORED","message":"frames[1]"}})"),
            ErrorReason::MIRRORED);
  EXPECT_EQ(told(exited(3), R"({"error":{"reason":"MADE_UP"}})"), ErrorReason::INPUT_REFUSED);
  EXPECT_EQ(told(exited(3), R"({"error":"reason"})"), ErrorReason::INPUT_REFUSED);
  EXPECT_EQ(told(exited(3), std::string(100000, '{')), ErrorReason::INPUT_REFUSED);
  EXPECT_EQ(told(SIGSEGV, R"({"error":{"reason":"MIRRORED"}})"), ErrorReason::WORKER_KILLED);
}

TEST(Outcome, MessageAndFieldAreThoseOfTheWorkersFailure) {
  const auto failure =
      judge(exited(3), StopReason::kNothing, "hydroprint-worker: --dpi: too large\n",
            R"({"error":{"message":"too large","field":"dpi"}})");
  EXPECT_EQ(failure->error.message, "too large");
  EXPECT_EQ(failure->error.field, "dpi");
}

// The worker is untrusted: a failure is read like a request, and nothing is taken from its stderr.
TEST(Outcome, AFailureThatIsNotOneIsNotUsed) {
  for (const std::string bad :
       {R"({"error":{"message":"x","field":7}})", R"({"error":{"message":"x","remark":"y"}})",
        R"({"error":{"message":"x","reason":"MADE_UP"}})",
        R"({"error":{"message":"x","code":NaN}})", R"({"error":["x"]})", "{"}) {
    const auto failure = judge(exited(3), StopReason::kNothing, "spot.obj: bad\n", bad);
    EXPECT_EQ(failure->error.message, "the worker refused its input without a message") << bad;
    EXPECT_EQ(failure->error.field, "") << bad;
  }
  const std::string long_text = R"({"error":{"message":")" + std::string(10 << 20, 'x') + "\"}}";
  EXPECT_LE(judge(exited(3), StopReason::kNothing, "", long_text)->error.message.size(), 1000U);
}

TEST(Outcome, EachKindOfEndHasItsReason) {
  EXPECT_EQ(reason(exited(2)), ErrorReason::INPUT_REFUSED);
  EXPECT_EQ(reason(exited(4), "it failed"), ErrorReason::COMPUTATION_FAILED);
  EXPECT_EQ(reason(exited(127)), ErrorReason::WORKER_UNUSABLE);
  EXPECT_EQ(reason(exited(1)), ErrorReason::COMPUTATION_FAILED);
  EXPECT_EQ(reason(SIGSEGV), ErrorReason::WORKER_KILLED);
  EXPECT_EQ(reason(SIGKILL), ErrorReason::WORKER_KILLED);
  EXPECT_EQ(reason(SIGXCPU), ErrorReason::TIME_LIMIT);
  EXPECT_EQ(reason(SIGXFSZ), ErrorReason::OUTPUT_LIMIT);
  EXPECT_EQ(reason(SIGKILL, "", StopReason::kTime), ErrorReason::TIME_LIMIT);
  EXPECT_EQ(reason(SIGKILL, "", StopReason::kMemory), ErrorReason::MEMORY_LIMIT);
}

TEST(Outcome, LimitsAreToldByReasonCodesAndNotByWords) {
  const auto told = [](const std::string& reason) {
    return judge(exited(4), StopReason::kNothing, "words",
                 R"({"error":{"reason":")" + reason + "\"}}")
        ->error;
  };
  EXPECT_EQ(told("MEMORY_LIMIT").reason, ErrorReason::MEMORY_LIMIT);
  EXPECT_EQ(told("DISK_FULL").reason, ErrorReason::DISK_FULL);
  EXPECT_EQ(told("OUTPUT_LIMIT").reason, ErrorReason::OUTPUT_LIMIT);
  EXPECT_EQ(told("DISK_FULL").code, Code::kResourceExhausted);
  EXPECT_EQ(reason(exited(4), "out of memory, the disk is full"), ErrorReason::COMPUTATION_FAILED);
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
