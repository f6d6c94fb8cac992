#include "daemon/confine/sandbox.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "daemon/confine/call_filter.h"

namespace hydroprint::confine {
namespace {

template <class Resource>
bool limit(Resource resource, std::int64_t value, std::int64_t hard_extra = 0) {
  rlimit old{};
  if (getrlimit(resource, &old) != 0) return false;
  const rlimit limits{std::min(static_cast<rlim_t>(value), old.rlim_max),
                      std::min(static_cast<rlim_t>(value + hard_extra), old.rlim_max)};
  return setrlimit(resource, &limits) == 0;
}

template <class Resource>
bool limit_if_set(Resource resource, std::int64_t value, std::int64_t hard_extra = 0) {
  return value == 0 || limit(resource, value, hard_extra);
}

// If memory runs short, the kernel kills a worker rather than the daemon.
void raise_oom_score() {
  const int file = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  if (::write(file, "500", 3) < 0) errno = 0;  // not essential
  ::close(file);
}

}  // namespace

const char* limit_use(const Limits& limits) {
  raise_oom_score();
  if (!limit(RLIMIT_CORE, 0) || !limit(RLIMIT_NOFILE, 256) ||
      !limit_if_set(RLIMIT_FSIZE, limits.file_bytes) ||
      !limit_if_set(RLIMIT_CPU, limits.cpu_s, 5) || !limit(RLIMIT_RTPRIO, 0) ||
      !limit(RLIMIT_NICE, 0)) {
    return "cannot set resource limits";
  }
  // The pool monitors actual use. This limit stops growth that is too fast for the pool, with a
  // margin for memory that is reserved but not used.
  constexpr std::int64_t kReserved = 512LL << 20;
  if (limits.memory_bytes > 0 &&
      !limit(RLIMIT_DATA, limits.memory_bytes + limits.memory_bytes / 4 + kReserved)) {
    return "cannot set the memory limit";
  }
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return "cannot give up privileges";
  return nullptr;
}

const char* confine(const Limits& limits, const Files& files) {
  if (const char* const step = limit_use(limits)) return step;
  const int version = landlock_version();
  if (version == 0 && limits.needs_landlock) {
    return "this kernel or container has no Landlock; use one that has it, or set "
           "workers.allow_without_landlock (flag --allow-without-landlock)";
  }
  if (version > 0 && !restrict_files(files, version)) return "cannot restrict file access";
  if (!filter_system_calls()) {
    return "cannot install the system call filter; use a kernel and a container that allow it";
  }
  return nullptr;
}

void give_up(const char* step) {
  const char* const reason = ::strerrordesc_np(errno);
  for (const char* part : {"the worker cannot be started: ", step, ": ", reason, "\n"}) {
    if (::write(2, part, std::strlen(part)) < 0) break;
  }
  ::_exit(127);
}

}  // namespace hydroprint::confine
