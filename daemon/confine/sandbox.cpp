#include "daemon/confine/sandbox.h"

#include <fcntl.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

namespace hydroprint::confine {
namespace {

// System calls that fail with EACCES. Sockets of all families are denied: no network, and no
// contact with other services of the same user. io_uring could open sockets despite the filter, and
// truncate() bypasses older versions of Landlock. The other calls access other processes, leave the
// process group, raise a priority or change the kernel.
constexpr std::array kRefused{
    SCMP_SYS(socket),
    SCMP_SYS(connect),
    SCMP_SYS(bind),
    SCMP_SYS(listen),
    SCMP_SYS(accept),
    SCMP_SYS(accept4),
    SCMP_SYS(io_uring_setup),
    SCMP_SYS(io_uring_enter),
    SCMP_SYS(io_uring_register),
    SCMP_SYS(ptrace),
    SCMP_SYS(process_vm_readv),
    SCMP_SYS(process_vm_writev),
    SCMP_SYS(kill),
    SCMP_SYS(tkill),
    SCMP_SYS(rt_sigqueueinfo),
    SCMP_SYS(pidfd_open),
    SCMP_SYS(pidfd_getfd),
    SCMP_SYS(pidfd_send_signal),
    SCMP_SYS(mount),
    SCMP_SYS(umount2),
    SCMP_SYS(pivot_root),
    SCMP_SYS(chroot),
    SCMP_SYS(open_tree),
    SCMP_SYS(move_mount),
    SCMP_SYS(fsopen),
    SCMP_SYS(unshare),
    SCMP_SYS(setns),
    SCMP_SYS(setsid),
    SCMP_SYS(setpgid),
    SCMP_SYS(truncate),
    SCMP_SYS(sched_setattr),
    SCMP_SYS(sched_setparam),
    SCMP_SYS(sched_setscheduler),
    SCMP_SYS(setpriority),
    SCMP_SYS(bpf),
    SCMP_SYS(perf_event_open),
    SCMP_SYS(userfaultfd),
    SCMP_SYS(keyctl),
    SCMP_SYS(add_key),
    SCMP_SYS(request_key),
};

constexpr std::uint32_t kRefuse = SCMP_ACT_ERRNO(EACCES);

struct FreeFilter {
  void operator()(void* filter) const { seccomp_release(filter); }
};

// Sets errno from a negative result of libseccomp; returns whether the result is a success.
bool succeeded(int result) {
  if (result < 0) errno = -result;
  return result >= 0;
}

// With these calls, a process may signal its own threads and access its own limits, but not signal
// other processes or access their limits. exec keeps the process id.
bool refuse_others(scmp_filter_ctx filter) {
  const auto refuse_unless = [filter](int call, pid_t allowed) {
    const auto id = static_cast<scmp_datum_t>(allowed);
    return succeeded(seccomp_rule_add(filter, kRefuse, call, 1, SCMP_A0_64(SCMP_CMP_NE, id, 0)));
  };
  return refuse_unless(SCMP_SYS(tgkill), ::getpid()) &&
         refuse_unless(SCMP_SYS(rt_tgsigqueueinfo), ::getpid()) &&
         refuse_unless(SCMP_SYS(prlimit64), 0);
}

bool filter_system_calls() {
  const std::unique_ptr<void, FreeFilter> filter(seccomp_init(SCMP_ACT_ALLOW));
  if (!filter) return succeeded(-ENOMEM);
  for (const int call : kRefused) {
    if (!succeeded(seccomp_rule_add(filter.get(), kRefuse, call, 0))) return false;
  }
  // The kernel's reason is in errno. The result of seccomp_load() does not tell it.
  return refuse_others(filter.get()) && seccomp_load(filter.get()) == 0;
}

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
  if (!restrict_files(files)) return "cannot restrict file access";
  return filter_system_calls() ? nullptr : "cannot install the system call filter";
}

void give_up(const char* step) {
  const char* const reason = ::strerrordesc_np(errno);
  for (const char* part : {"the worker cannot be started: ", step, ": ", reason, "\n"}) {
    if (::write(2, part, std::strlen(part)) < 0) break;
  }
  ::_exit(127);
}

}  // namespace hydroprint::confine
