// What a thread gets from the system, with the limits of the service and without any rights.
#include "sim/base/process/real_time_thread.h"

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "tests/support/paths.h"

namespace hydroprint {
namespace {

constexpr uid_t kNobody = 65534;
constexpr int kPriority = 11;  // the greatest that the daemon requests

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLocksMemory = false;  // sanitizers replace mlock() by a function without effect
#else
constexpr bool kLocksMemory = true;
#endif

/// Scheduling of a thread or a process.
struct Schedule {
  int policy = -1;
  int nice = 0;
};

Schedule schedule() {
  return {::sched_getscheduler(0), ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()))};
}

/// What a process observed after it had called become_real_time().
struct Report {
  bool prepared = false;
  ThreadPriority got;
  Schedule before, after;
  Schedule child, thread;  ///< of a process and of a thread that it started
};

/// Runs `body` in a child process and returns what it writes to its argument.
template <class T>
T in_child(const std::function<void(T&)>& body) {
  std::array<int, 2> ends{};
  T out{};
  if (::pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    body(out);
    const bool is_written = ::write(ends[1], &out, sizeof out) == sizeof out;
    ::_exit(is_written ? 0 : 1);
  }
  ::close(ends[1]);
  EXPECT_EQ(::read(ends[0], &out, sizeof out), static_cast<ssize_t>(sizeof out));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  return out;
}

/// Calls become_real_time() in a child process, after `prepare`, which returns false if the system
/// does not permit the preparation.
Report request_after(const std::function<bool()>& prepare) {
  return in_child<Report>([&](Report& report) {
    report.prepared = prepare();
    report.before = schedule();
    report.got = become_real_time(kPriority);
    report.after = schedule();
    report.child = in_child<Schedule>([](Schedule& child) { child = schedule(); });
    std::thread([&] { report.thread = schedule(); }).join();
  });
}

bool limit(__rlimit_resource_t resource, rlim_t value) {
  const rlimit both{value, value};
  return ::setrlimit(resource, &both) == 0;
}

/// Gives up all capabilities by becoming an ordinary user.
bool become_nobody() {
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  return ::geteuid() != 0 || (::setresgid(kNobody, kNobody, kNobody) == 0 &&
                              ::setresuid(kNobody, kNobody, kNobody) == 0);
}

/// Makes the system refuse SCHED_FIFO, also to root.
bool forbid_fifo() {
  constexpr std::uint32_t kPolicy = offsetof(seccomp_data, args[1]);
  std::array<sock_filter, 7> rules{{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, __NR_sched_setscheduler, 0, 4),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kPolicy),
      BPF_STMT(BPF_ALU | BPF_AND | BPF_K, 0xff),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SCHED_FIFO, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  }};
  const sock_fprog program{rules.size(), rules.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// Returns whether the system grants SCHED_FIFO to this process as it is.
bool may_use_fifo() {
  return in_child<bool>([](bool& may) {
    const sched_param request{.sched_priority = kPriority};
    may = ::sched_setscheduler(0, SCHED_FIFO, &request) == 0;
  });
}

bool may_lower_nice_value() {
  return in_child<bool>([](bool& may) { may = ::setpriority(PRIO_PROCESS, 0, -1) == 0; });
}

/// Value of a setting of the service; empty if the unit does not contain it.
std::string setting(const std::string& name) {
  std::ifstream unit(testing::source_path("deploy/systemd/hydroprintd.service"));
  for (std::string line; std::getline(unit, line);) {
    if (line.starts_with(name + "=")) return line.substr(name.size() + 1);
  }
  return "";
}

void expect_fifo(const Report& report) {
  EXPECT_EQ(report.got.scheduling, Scheduling::kRealTime);
  EXPECT_EQ(report.after.policy, SCHED_FIFO | SCHED_RESET_ON_FORK);
}

/// Expects the scheduling of an ordinary process.
void expect_ordinary(const Schedule& schedule, int nice) {
  EXPECT_EQ(schedule.policy, SCHED_OTHER);
  EXPECT_EQ(schedule.nice, nice);
}

TEST(RealTimeThread, IsGrantedWithTheLimitsOfTheService) {
  EXPECT_EQ(setting("RestrictRealtime"), "") << "it would forbid SCHED_FIFO";
  ASSERT_NE(setting("LimitRTPRIO"), "");
  const auto priority = static_cast<rlim_t>(std::stoi(setting("LimitRTPRIO")));
  EXPECT_GE(priority, static_cast<rlim_t>(kPriority));
  const Report service =
      request_after([&] { return limit(RLIMIT_RTPRIO, priority) && become_nobody(); });
  const bool is_granted = may_use_fifo();
  if (service.prepared && (is_granted || ::geteuid() != 0)) {
    expect_fifo(service);
    expect_ordinary(service.child, 0);
    expect_ordinary(service.thread, 0);
    return;
  }
  // This user must not raise the limit, or the kernel grants SCHED_FIFO to nobody.
  const Report own = request_after([] { return true; });
  if (!is_granted) {
    EXPECT_NE(own.got.scheduling, Scheduling::kRealTime);
    return;
  }
  expect_fifo(own);
  expect_ordinary(own.child, 0);
  expect_ordinary(own.thread, 0);
}

TEST(RealTimeThread, KeepsItsPriorityWithoutAnyRights) {
  const Report report = request_after([] {
    return limit(RLIMIT_RTPRIO, 0) && limit(RLIMIT_NICE, 0) && limit(RLIMIT_MEMLOCK, 0) &&
           become_nobody();
  });
  ASSERT_TRUE(report.prepared);
  EXPECT_EQ(report.got.scheduling, Scheduling::kNormal);
  EXPECT_EQ(report.after.policy, SCHED_OTHER | SCHED_RESET_ON_FORK);
  EXPECT_EQ(report.after.nice, report.before.nice);
  EXPECT_EQ(report.got.memory_locked, !kLocksMemory);
  expect_ordinary(report.child, report.before.nice);
}

TEST(RealTimeThread, TakesTheLowestNiceValueIfFifoIsRefused) {
  const Report report = request_after(forbid_fifo);
  ASSERT_TRUE(report.prepared);
  EXPECT_EQ(report.after.policy, SCHED_OTHER | SCHED_RESET_ON_FORK);
  if (!may_lower_nice_value()) {
    EXPECT_EQ(report.got.scheduling, Scheduling::kNormal);
    return;
  }
  EXPECT_EQ(report.got.scheduling, Scheduling::kRaised);
  EXPECT_LT(report.after.nice, 0);
  expect_ordinary(report.child, 0);
  expect_ordinary(report.thread, 0);
}

TEST(RealTimeThread, LocksMemoryWithinTheLimit) {
  const auto locks = [](rlim_t bytes) {
    return in_child<bool>([&](bool& out) {
      const std::string memory(1 << 14, 'x');
      out = limit(RLIMIT_MEMLOCK, bytes) && become_nobody() &&
            lock_memory(memory.data(), memory.size());
    });
  };
  EXPECT_EQ(locks(0), !kLocksMemory);
  rlimit now{};
  ASSERT_EQ(::getrlimit(RLIMIT_MEMLOCK, &now), 0);
  EXPECT_EQ(locks(1 << 16), now.rlim_max >= 1 << 16 || !kLocksMemory);
}

}  // namespace
}  // namespace hydroprint
