#include "daemon/workers/sandbox.h"

#include <fcntl.h>
#include <linux/seccomp.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>

#include "daemon/platform/durable_file.h"
#include "daemon/workers/landlock.h"

namespace hydroprint::daemon {
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

constexpr const char* kNoSandbox =
    "this machine cannot confine workers (seccomp); use a kernel and a container that allow "
    "seccomp filters";

struct FreeFilter {
  void operator()(void* filter) const { seccomp_release(filter); }
};

Result<std::vector<sock_filter>> compile_filter() {
  const std::unique_ptr<void, FreeFilter> filter(seccomp_init(SCMP_ACT_ALLOW));
  const UniqueFd file(memfd_create("seccomp", MFD_CLOEXEC));
  bool good = filter && file.valid();
  constexpr std::uint32_t kRefuse = SCMP_ACT_ERRNO(EACCES);
  for (const int call : kRefused) {
    good = good && seccomp_rule_add(filter.get(), kRefuse, call, 0) == 0;
  }
  // With these calls, a worker may signal its own threads and access its own limits, but not signal
  // the daemon or access the limits of other processes.
  const auto daemon = static_cast<scmp_datum_t>(::getpid());
  good = good &&
         seccomp_rule_add(filter.get(), kRefuse, SCMP_SYS(tgkill), 1,
                          SCMP_A0_64(SCMP_CMP_EQ, daemon, 0)) == 0 &&
         seccomp_rule_add(filter.get(), kRefuse, SCMP_SYS(rt_tgsigqueueinfo), 1,
                          SCMP_A0_64(SCMP_CMP_EQ, daemon, 0)) == 0 &&
         seccomp_rule_add(filter.get(), kRefuse, SCMP_SYS(prlimit64), 1,
                          SCMP_A0_64(SCMP_CMP_NE, 0, 0)) == 0;
  good = good && seccomp_export_bpf(filter.get(), file.get()) == 0;
  struct stat info {};
  good = good && fstat(file.get(), &info) == 0;
  if (!good) return fail(Code::kFailedPrecondition, kNoSandbox);
  std::vector<sock_filter> program(static_cast<std::size_t>(info.st_size) / sizeof(sock_filter));
  const std::size_t bytes = program.size() * sizeof(sock_filter);
  if (::pread(file.get(), program.data(), bytes, 0) != static_cast<ssize_t>(bytes)) {
    return fail(Code::kFailedPrecondition, kNoSandbox);
  }
  return program;
}

template <class Resource>
bool limit(Resource resource, std::int64_t value, std::int64_t hard_extra = 0) {
  rlimit old{};
  if (getrlimit(resource, &old) != 0) return false;
  const rlimit limits{std::min(static_cast<rlim_t>(value), old.rlim_max),
                      std::min(static_cast<rlim_t>(value + hard_extra), old.rlim_max)};
  return setrlimit(resource, &limits) == 0;
}

// If memory runs short, the kernel kills a worker rather than the daemon.
void raise_oom_score() {
  const int file = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  if (::write(file, "500", 3) < 0) errno = 0;  // not essential
  ::close(file);
}

}  // namespace

Result<Sandbox> Sandbox::make() {
  Sandbox sandbox;
  HP_ASSIGN_OR_RETURN(sandbox.filter_, compile_filter());
  return sandbox;
}

const char* Sandbox::limit_use(const Limits& limits) {
  raise_oom_score();
  if (!limit(RLIMIT_CORE, 0) || !limit(RLIMIT_NOFILE, 256) ||
      !limit(RLIMIT_FSIZE, limits.file_bytes) || !limit(RLIMIT_CPU, limits.cpu_s, 5) ||
      !limit(RLIMIT_RTPRIO, 0) || !limit(RLIMIT_NICE, 0)) {
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

const char* Sandbox::confine(const Limits& limits, int ruleset) const {
  if (const char* const failed = limit_use(limits)) return failed;
  if (!apply_ruleset(ruleset)) return "cannot restrict file access";
  const sock_fprog program{static_cast<unsigned short>(filter_.size()),
                           const_cast<sock_filter*>(filter_.data())};
  if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
    return "cannot install the system call filter";
  return nullptr;
}

}  // namespace hydroprint::daemon
