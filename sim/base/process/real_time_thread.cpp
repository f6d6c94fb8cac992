#include "sim/base/process/real_time_thread.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>

namespace hydroprint {
namespace {

constexpr std::size_t kStackBytes = std::size_t{64} << 10;
constexpr std::size_t kSmallestPage = 4096;
constexpr int kLowestNice = -20;

// Not with ThreadSanitizer: its runtime spins on locks, and a SCHED_FIFO thread that spins can keep
// the thread that holds the lock from running.
bool request_fifo(int priority) {
#ifdef __SANITIZE_THREAD__
  (void)priority;
  return false;
#else
  const sched_param request{.sched_priority = priority};
  return ::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &request) == 0;
#endif
}

// Requests the lowest nice value that the system grants. Linux has a nice value for every thread.
Scheduling lower_nice_value() {
  const sched_param ordinary{};
  (void)::sched_setscheduler(0, SCHED_OTHER | SCHED_RESET_ON_FORK, &ordinary);
  const auto thread = static_cast<id_t>(::gettid());
  const int before = ::getpriority(PRIO_PROCESS, thread);
  int nice = kLowestNice;
  while (nice < before && ::setpriority(PRIO_PROCESS, thread, nice) != 0) ++nice;
  return ::getpriority(PRIO_PROCESS, thread) < 0 ? Scheduling::kRaised : Scheduling::kNormal;
}

// The array is where the frames of the caller's later calls will be. The writes load its pages even
// if the system refuses to lock them.
[[gnu::noinline]] bool lock_stack() {
  std::array<volatile char, kStackBytes> frames;
  for (std::size_t i = 0; i < kStackBytes; i += kSmallestPage) frames[i] = 0;
  return lock_memory(const_cast<const char*>(frames.data()), frames.size());
}

}  // namespace

ThreadPriority become_real_time(int fifo_priority) {
  const auto scheduling = request_fifo(fifo_priority) ? Scheduling::kRealTime : lower_nice_value();
  return {scheduling, lock_stack()};
}

bool lock_memory(const void* start, std::size_t bytes) { return ::mlock(start, bytes) == 0; }

}  // namespace hydroprint
