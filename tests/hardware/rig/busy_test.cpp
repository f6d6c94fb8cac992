// Motions on a machine whose processors are all busy.
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <iostream>
#include <thread>
#include <vector>

#include "tests/hardware/rig/wired_rig.h"
#include "tests/support/campaign.h"

namespace hydroprint::rig {
namespace {

using Outcome = MotionReport::Outcome;

constexpr int kMotions = 20;
constexpr double kSpeed_mm_per_s = 10;
constexpr double kNear_mm = 20;

/// A process on each processor that computes without a pause, at normal priority.
class BusyProcessors {
 public:
  BusyProcessors() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    (void)::sched_getaffinity(0, sizeof allowed, &allowed);
    for (int i = 0; i < CPU_COUNT(&allowed); ++i) {
      processes_.push_back(::fork());
      if (processes_.back() == 0) compute();
    }
  }
  ~BusyProcessors() {
    for (const pid_t process : processes_) {
      ::kill(process, SIGKILL);
      ::waitpid(process, nullptr, 0);
    }
  }
  BusyProcessors(const BusyProcessors&) = delete;
  BusyProcessors& operator=(const BusyProcessors&) = delete;

 private:
  [[noreturn]] static void compute() {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    (void)::setpriority(PRIO_PROCESS, 0, 0);
    for (volatile unsigned i = 0;;) i = i + 1;
  }

  std::vector<pid_t> processes_;
};

/// Moves there, or dips there and back.
MotionReport travel(WiredRig& rig, bool dips, double target_mm) {
  const Leg there{target_mm, kSpeed_mm_per_s, 0};
  const Answer motion =
      (dips ? rig->dip({there, {kNear_mm, kSpeed_mm_per_s, 0}}) : rig->move_to(target_mm, 10))
          .get();
  EXPECT_TRUE(motion) << motion.error().message;
  return rig.finish(motion.value_or(0));
}

/// Jogs down, then up, at changing speeds, and ends at standstill.
MotionReport jog(WiredRig& rig) {
  std::uint64_t number = 0;
  for (const double speed_mm_per_s : {5.0, 10.0, 2.0, -4.0, -8.0}) {
    const Answer motion = rig->jog(speed_mm_per_s).get();
    EXPECT_TRUE(motion) << motion.error().message;
    number = motion.value_or(number);
    std::this_thread::sleep_for(std::chrono::milliseconds(120));
  }
  return rig.finish(number);
}

TEST(Busy, OtherProcessesDoNotDisturbMotions) {
  const BusyProcessors busy;
  WiredRig rig("tcp");
  rig.make_ready();
  const Snapshot before = rig->snapshot();
  if (before.priority.scheduling != Scheduling::kRealTime) {
    GTEST_SKIP()
        << "the system does not grant SCHED_FIFO to this user; run the test as root or set "
           "RLIMIT_RTPRIO to 20";
  }
  // Short motions in tests/run, long ones in the campaign.
  const double travel_mm = kSpeed_mm_per_s * (testing::campaign_rounds(1) > 1 ? 3 : 0.5);
  for (int i = 0; i < testing::campaign_rounds(kMotions); ++i) {
    MotionReport done;
    if (i % 5 == 3) {
      done = jog(rig);
      ASSERT_EQ(done.outcome, Outcome::kStopped) << "motion " << i;
    } else if (i % 10 == 4) {
      done = rig.finish(rig->home().get().value_or(0));
      ASSERT_EQ(done.outcome, Outcome::kDone) << "motion " << i;
    } else {
      done = travel(rig, i % 5 == 2, kNear_mm + (i % 2 == 0 ? travel_mm : 0));
      ASSERT_EQ(done.outcome, Outcome::kDone) << "motion " << i;
    }
    ASSERT_EQ(done.cause, Cause::kNone) << "motion " << i;
  }
  const Snapshot now = rig->snapshot();
  EXPECT_EQ(now.condition.state, State::kIdle);
  EXPECT_EQ(now.connects, before.connects) << "the link was lost";
  std::cout << now.missed_polls - before.missed_polls << " missed and "
            << now.jitter.late - before.jitter.late << " late of "
            << now.jitter.ticks - before.jitter.ticks << " polls, at most "
            << 1000 * now.jitter.largest_s << " ms late\n";
}

}  // namespace
}  // namespace hydroprint::rig
