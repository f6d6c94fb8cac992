#include "daemon/confine/call_filter.h"

#include <fcntl.h>
#include <linux/filter.h>
#include <linux/fs.h>
#include <linux/sockios.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace hydroprint::confine {
namespace {

constexpr std::array kRefused{
    // Sockets of all families: no network, and no contact with other services of the same user.
    // io_uring could open them despite the filter.
    SCMP_SYS(socket),
    SCMP_SYS(socketpair),
    SCMP_SYS(connect),
    SCMP_SYS(bind),
    SCMP_SYS(listen),
    SCMP_SYS(accept),
    SCMP_SYS(accept4),
    SCMP_SYS(io_uring_setup),
    SCMP_SYS(io_uring_enter),
    SCMP_SYS(io_uring_register),
    // Memory and messages that outlive the process, or that do not count as its memory.
    SCMP_SYS(shmget),
    SCMP_SYS(shmat),
    SCMP_SYS(shmctl),
    SCMP_SYS(semget),
    SCMP_SYS(semop),
    SCMP_SYS(semtimedop),
    SCMP_SYS(semctl),
    SCMP_SYS(msgget),
    SCMP_SYS(msgsnd),
    SCMP_SYS(msgrcv),
    SCMP_SYS(msgctl),
    SCMP_SYS(mq_open),
    SCMP_SYS(mq_unlink),
    SCMP_SYS(memfd_create),
    SCMP_SYS(memfd_secret),
    // Owner, mode, times and attributes of files, which Landlock does not protect; truncation by
    // name, which it covers since version 3.
    SCMP_SYS(chmod),
    SCMP_SYS(fchmod),
    SCMP_SYS(fchmodat),
    SCMP_SYS(chown),
    SCMP_SYS(lchown),
    SCMP_SYS(fchown),
    SCMP_SYS(fchownat),
    SCMP_SYS(setxattr),
    SCMP_SYS(lsetxattr),
    SCMP_SYS(fsetxattr),
    SCMP_SYS(removexattr),
    SCMP_SYS(lremovexattr),
    SCMP_SYS(fremovexattr),
    SCMP_SYS(utime),
    SCMP_SYS(utimes),
    SCMP_SYS(futimesat),
    SCMP_SYS(utimensat),
    SCMP_SYS(truncate),
    SCMP_SYS(open_by_handle_at),
    // Watching files of others.
    SCMP_SYS(inotify_init),
    SCMP_SYS(inotify_init1),
    SCMP_SYS(inotify_add_watch),
    SCMP_SYS(fanotify_init),
    SCMP_SYS(fanotify_mark),
    // New processes. A worker only has threads, so its limits are those of one process.
    SCMP_SYS(fork),
    SCMP_SYS(vfork),
    // Access to other processes, process groups, priorities.
    SCMP_SYS(ptrace),
    SCMP_SYS(process_vm_readv),
    SCMP_SYS(process_vm_writev),
    SCMP_SYS(migrate_pages),
    SCMP_SYS(move_pages),
    SCMP_SYS(kill),
    SCMP_SYS(tkill),
    SCMP_SYS(rt_sigqueueinfo),
    SCMP_SYS(pidfd_open),
    SCMP_SYS(pidfd_getfd),
    SCMP_SYS(pidfd_send_signal),
    SCMP_SYS(setsid),
    SCMP_SYS(setpgid),
    SCMP_SYS(sched_setattr),
    SCMP_SYS(sched_setparam),
    SCMP_SYS(sched_setscheduler),
    SCMP_SYS(setpriority),
    SCMP_SYS(ioprio_set),
    // The kernel and its namespaces.
    SCMP_SYS(mount),
    SCMP_SYS(umount2),
    SCMP_SYS(pivot_root),
    SCMP_SYS(chroot),
    SCMP_SYS(open_tree),
    SCMP_SYS(move_mount),
    SCMP_SYS(mount_setattr),
    SCMP_SYS(fsopen),
    SCMP_SYS(fspick),
    SCMP_SYS(unshare),
    SCMP_SYS(setns),
    SCMP_SYS(bpf),
    SCMP_SYS(perf_event_open),
    SCMP_SYS(userfaultfd),
    SCMP_SYS(keyctl),
    SCMP_SYS(add_key),
    SCMP_SYS(request_key),
};

// Calls whose arguments a filter cannot see, or that have a replacement, which libraries use after
// this error.
struct Missing {
  int call;
  std::uint16_t error;
};
constexpr std::array kMissing{
    Missing{SCMP_SYS(clone3), ENOSYS},
    Missing{SCMP_SYS(openat2), ENOSYS},
    // Disk space that is not counted as written by the process (write_bytes in /proc/PID/io).
    Missing{SCMP_SYS(fallocate), EOPNOTSUPP},
};

// Calls that are refused if `mask` selects `value` from the lower half of an argument. The kernel
// ignores the upper half of these arguments, so a filter must do the same.
struct Argument {
  int call;
  unsigned index;
  std::uint32_t mask, value;
};
constexpr std::uint32_t kWhole = ~0U;
constexpr std::uint32_t kShared = MAP_SHARED | MAP_ANONYMOUS;
constexpr std::uint32_t kTruncation = O_TRUNC | O_ACCMODE;
// Of the kernel's falloc.h, which is not installed.
constexpr std::uint32_t kReserve = 0x40305828, kReserve64 = 0x4030582a, kZeroRange = 0x40305839;
constexpr std::array kRefusedArguments{
    // Signals that the kernel sends to any process, leases, and the memory of pipes.
    Argument{SCMP_SYS(fcntl), 1, kWhole, F_SETOWN},
    Argument{SCMP_SYS(fcntl), 1, kWhole, F_SETOWN_EX},
    Argument{SCMP_SYS(fcntl), 1, kWhole, F_SETSIG},
    Argument{SCMP_SYS(fcntl), 1, kWhole, F_NOTIFY},
    Argument{SCMP_SYS(fcntl), 1, kWhole, F_SETLEASE},
    Argument{SCMP_SYS(fcntl), 1, kWhole, F_SETPIPE_SZ},
    Argument{SCMP_SYS(ioctl), 1, kWhole, FIOSETOWN},
    Argument{SCMP_SYS(ioctl), 1, kWhole, SIOCSPGRP},
    Argument{SCMP_SYS(ioctl), 1, kWhole, FIOASYNC},
    // Input of a terminal, attributes of files, and disk space as with fallocate().
    Argument{SCMP_SYS(ioctl), 1, kWhole, TIOCSTI},
    Argument{SCMP_SYS(ioctl), 1, kWhole, TIOCLINUX},
    Argument{SCMP_SYS(ioctl), 1, kWhole, FS_IOC_SETFLAGS},
    Argument{SCMP_SYS(ioctl), 1, kWhole, FS_IOC_FSSETXATTR},
    Argument{SCMP_SYS(ioctl), 1, kWhole, kReserve},
    Argument{SCMP_SYS(ioctl), 1, kWhole, kReserve64},
    Argument{SCMP_SYS(ioctl), 1, kWhole, kZeroRange},
    // Everything except a thread.
    Argument{SCMP_SYS(clone), 0, CLONE_THREAD, 0},
    Argument{SCMP_SYS(clone), 0, CLONE_NEWNS, CLONE_NEWNS},
    Argument{SCMP_SYS(clone), 0, CLONE_NEWCGROUP, CLONE_NEWCGROUP},
    Argument{SCMP_SYS(clone), 0, CLONE_NEWUTS, CLONE_NEWUTS},
    Argument{SCMP_SYS(clone), 0, CLONE_NEWIPC, CLONE_NEWIPC},
    Argument{SCMP_SYS(clone), 0, CLONE_NEWUSER, CLONE_NEWUSER},
    Argument{SCMP_SYS(clone), 0, CLONE_NEWPID, CLONE_NEWPID},
    Argument{SCMP_SYS(clone), 0, CLONE_NEWNET, CLONE_NEWNET},
    // Truncation of a file that is not opened for writing, which Landlock denies since version 3.
    // The access modes that do this are O_RDONLY and 3.
    Argument{SCMP_SYS(open), 1, kTruncation, O_TRUNC | O_RDONLY},
    Argument{SCMP_SYS(open), 1, kTruncation, kTruncation},
    Argument{SCMP_SYS(openat), 2, kTruncation, O_TRUNC | O_RDONLY},
    Argument{SCMP_SYS(openat), 2, kTruncation, kTruncation},
    // Memory that the process can keep without being charged for it (MADV_DONTNEED).
    Argument{SCMP_SYS(mmap), 3, kShared, kShared},
    // A process that outlives the daemon, or hides /proc/PID/io from it.
    Argument{SCMP_SYS(prctl), 0, kWhole, PR_SET_PDEATHSIG},
    Argument{SCMP_SYS(prctl), 0, kWhole, PR_SET_DUMPABLE},
};

constexpr std::uint32_t kRefuse = SCMP_ACT_ERRNO(EPERM);

struct FreeFilter {
  void operator()(void* filter) const { seccomp_release(filter); }
};

// Sets errno from a negative result of libseccomp; returns whether the result is a success.
bool succeeded(int result) {
  if (result < 0) errno = -result;
  return result >= 0;
}

scmp_arg_cmp selects(const Argument& argument) {
  return SCMP_CMP64(argument.index, SCMP_CMP_MASKED_EQ, argument.mask, argument.value);
}

// With these calls, a process may access itself: signal its threads, change its limits and, with
// the id 0, the cores of the calling thread. exec keeps the process id.
bool refuse_others(scmp_filter_ctx filter) {
  const auto refuse_unless = [filter](int call, pid_t allowed) {
    const auto id = static_cast<scmp_datum_t>(allowed);
    return succeeded(seccomp_rule_add(filter, kRefuse, call, 1, SCMP_A0_64(SCMP_CMP_NE, id, 0)));
  };
  return refuse_unless(SCMP_SYS(tgkill), ::getpid()) &&
         refuse_unless(SCMP_SYS(rt_tgsigqueueinfo), ::getpid()) &&
         refuse_unless(SCMP_SYS(prlimit64), 0) && refuse_unless(SCMP_SYS(sched_setaffinity), 0);
}

bool refuse_arguments(scmp_filter_ctx filter) {
  const auto refuse = [filter](const Argument& argument) {
    return succeeded(seccomp_rule_add(filter, kRefuse, argument.call, 1, selects(argument)));
  };
  const Argument set_flags{SCMP_SYS(fcntl), 1, kWhole, F_SETFL};
  const Argument with_signals{SCMP_SYS(fcntl), 2, O_ASYNC, O_ASYNC};
  return std::all_of(kRefusedArguments.begin(), kRefusedArguments.end(), refuse) &&
         succeeded(seccomp_rule_add(filter, kRefuse, set_flags.call, 2, selects(set_flags),
                                    selects(with_signals)));
}

bool refuse_calls(scmp_filter_ctx filter) {
  const auto add = [filter](int call, std::uint32_t action) {
    return succeeded(seccomp_rule_add(filter, action, call, 0));
  };
  return std::all_of(kRefused.begin(), kRefused.end(),
                     [&](int call) { return add(call, kRefuse); }) &&
         std::all_of(kMissing.begin(), kMissing.end(), [&](const Missing& missing) {
           return add(missing.call, SCMP_ACT_ERRNO(missing.error));
         });
}

// Calls that are newer than Linux 6.1 do not exist for workers, because the lists above do not know
// them. Some of them do what a refused one does, such as fchmodat2() and setxattrat().
bool hide_newer_calls() {
  constexpr std::uint32_t kFirstNewer = SYS_set_mempolicy_home_node + 1;
  std::array<sock_filter, 4> rules{{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kFirstNewer, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  }};
  const sock_fprog program{rules.size(), rules.data()};
  return ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

}  // namespace

bool filter_system_calls() {
  const std::unique_ptr<void, FreeFilter> filter(seccomp_init(SCMP_ACT_ALLOW));
  if (!filter) return succeeded(-ENOMEM);
  // The kernel's reason is in errno. The result of seccomp_load() does not tell it.
  return refuse_calls(filter.get()) && refuse_arguments(filter.get()) &&
         refuse_others(filter.get()) && seccomp_load(filter.get()) == 0 && hide_newer_calls();
}

}  // namespace hydroprint::confine
