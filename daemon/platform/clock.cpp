#include "daemon/platform/clock.h"

#include <chrono>

namespace hydroprint::daemon {

std::int64_t system_clock_ms() {
  using std::chrono::milliseconds;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<milliseconds>(now).count();
}

}  // namespace hydroprint::daemon
