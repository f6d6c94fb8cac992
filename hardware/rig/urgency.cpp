#include "hardware/rig/urgency.h"

#include <sched.h>

namespace hydroprint::rig {
namespace {

// Above those that ask for the least; below the kernel's own threads, at 50.
constexpr int kPriority = 10;

}  // namespace

void go_first() noexcept {
  sched_param wanted{};
  wanted.sched_priority = kPriority;
  (void)::sched_setscheduler(0, SCHED_RR | SCHED_RESET_ON_FORK, &wanted);
}

}  // namespace hydroprint::rig
