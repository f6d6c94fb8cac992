// A worker that was taken over. The daemon starts it in the place of hydroprint-worker (`workers.program`). It answers
// `--version --json`, takes the command line of a worker, and plays the attack that the file "attack.obj" among the inputs
// of its job names:
//
//     attack NAME
//     set KEY VALUE
//
// It leaves the results of a sound job as far as the attack allows, and attempts.txt, which says of each system call
// whether it was refused. It ends with status 0, so that nothing but the daemon's own checks stops its results.
//
// An attack is directed at processes and files that the test names, so that one that succeeds harms nothing else.
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/sched.h>
#include <sched.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <sys/ipc.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <time.h>
#include <unistd.h>
#include <utime.h>

#ifndef FIOSETOWN
#define FIOSETOWN 0x8901
#endif
#ifndef SIOCSPGRP
#define SIOCSPGRP 0x8902
#endif

enum { kLongestLife_s = 30, kMarkedTime_s = 86400, kMib = 1 << 20 };

static char inputs[4096], spec[4096], out[4096], work[4096], progress_file[4096];
static char attack_text[65536], attempts[262144];

// The settings of the attack.

static const char* setting(const char* key, const char* fallback) {
  static char values[16][4096];
  static int next;
  char wanted[128];
  snprintf(wanted, sizeof wanted, "\nset %s ", key);
  const char* found = strstr(attack_text, wanted);
  if (!found) return fallback;
  found += strlen(wanted);
  char* value = values[next++ % 16];
  snprintf(value, sizeof values[0], "%.*s", (int)strcspn(found, "\r\n"), found);
  return value;
}

static long number(const char* key, long fallback) {
  const char* value = setting(key, NULL);
  return value ? atol(value) : fallback;
}

static void pause_ms(long ms) {
  struct timespec rest = {ms / 1000, ms % 1000 * 1000000};
  while (nanosleep(&rest, &rest) != 0 && errno == EINTR) {
  }
}

// Records an attempt. `result` is that of a system call.
static long attempt(long result, const char* format, ...) {
  int error = errno;
  char what[1024];
  va_list list;
  va_start(list, format);
  vsnprintf(what, sizeof what, format, list);
  va_end(list);
  size_t used = strlen(attempts);
  snprintf(attempts + used, sizeof attempts - used, "%s: %s\n", what, result < 0 ? strerror(error) : "done");
  errno = error;
  return result;
}

static const char* in(const char* folder, const char* name) {
  static char paths[16][8192];
  static int next;
  char* path = paths[next++ % 16];
  snprintf(path, sizeof paths[0], "%s/%s", folder, name);
  return path;
}

static int write_file(const char* path, const char* text) {
  int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) return -1;
  ssize_t written = write(file, text, strlen(text));
  close(file);
  return written == (ssize_t)strlen(text) ? 0 : -1;
}

// Leaves what a sound job leaves. The file contains the text `private`, so that the test knows whose it is.
static void leave_results(void) {
  char text[8192];
  if (!*out) return;
  mkdir(out, 0700);
  snprintf(text, sizeof text, "\x89PNG\r\n\x1a\n%s\n", setting("private", "nothing"));
  write_file(in(out, "film.png"), text);
  write_file(in(out, "report.json"), "{}\n");
}

static void leave_attempts(void) {
  if (*out) write_file(in(out, "attempts.txt"), attempts);
}

// 1. Output: links, special files, and changes after the worker has ended.

static void attack_link_out(const char* target) {
  const char* aside = in(work, "aside");
  if (attempt(rename(out, aside), "rename out") != 0) return;
  if (attempt(symlink(target, out), "symlink out -> %s", target) != 0) rename(aside, out);
}

static void attack_link_work(const char* target) {
  char parent[4096], aside[8192];
  snprintf(parent, sizeof parent, "%s", work);
  char* slash = strrchr(parent, '/');
  if (!slash) return;
  *slash = '\0';
  snprintf(aside, sizeof aside, "%s/aside", parent);
  if (attempt(rename(work, aside), "rename work") != 0) return;
  if (attempt(symlink(target, work), "symlink work -> %s", target) != 0) rename(aside, work);
}

static void link_name(const char* name, const char* target) {
  unlink(in(out, name));
  attempt(symlink(target, in(out, name)), "symlink %s -> %s", name, target);
}

static void attack_link_files(const char* target) {
  const char* key = in(target, "key.pem");
  link_name("film.png", key);
  link_name("surface_map.ply", key);
  link_name("folder", target);
  link_name("chain.png", "film.png");
  link_name("itself.png", "itself.png");
  // The same by a way that begins in the daemon's own process.
  char by_root[8192];
  snprintf(by_root, sizeof by_root, "/proc/self/root%s", key);
  link_name("root.png", by_root);
  mkdir(in(out, "below"), 0700);
  link_name("below/film.png", key);
}

static void attack_link_report(const char* target) { link_name("report.json", in(target, "key.pem")); }

static void attack_hard_links(const char* target) {
  const char* sources[] = {in(target, "key.pem"), setting("database", "/nowhere")};
  for (int i = 0; i < 2; ++i) {
    char name[64], by_descriptor[64];
    snprintf(name, sizeof name, "stolen%d.png", i);
    attempt(link(sources[i], in(out, name)), "link %s", sources[i]);
    int path = open(sources[i], O_PATH | O_CLOEXEC);
    snprintf(by_descriptor, sizeof by_descriptor, "/proc/self/fd/%d", path);
    snprintf(name, sizeof name, "by-descriptor%d.png", i);
    attempt(linkat(AT_FDCWD, by_descriptor, AT_FDCWD, in(out, name), AT_SYMLINK_FOLLOW), "linkat %s", sources[i]);
    attempt(linkat(path, "", AT_FDCWD, in(out, name), AT_EMPTY_PATH), "linkat, empty path, %s", sources[i]);
    snprintf(name, sizeof name, "moved%d.png", i);
    attempt(rename(sources[i], in(out, name)), "rename %s", sources[i]);
    if (path >= 0) close(path);
  }
  attempt(rename(target, in(out, "folder")), "rename %s", target);
}

static void attack_read(const char* target) {
  const char* sources[] = {in(target, "key.pem"), setting("database", "/nowhere")};
  for (int i = 0; i < 2; ++i) {
    char data[4096], name[64];
    int file = open(sources[i], O_RDONLY | O_CLOEXEC);
    attempt(file, "read %s", sources[i]);
    if (file < 0) continue;
    ssize_t size = read(file, data, sizeof data - 1);
    data[size > 0 ? size : 0] = '\0';
    close(file);
    snprintf(name, sizeof name, "copy%d.png", i);
    write_file(in(out, name), data);
  }
}

static void attack_special(const char* target) {
  (void)target;
  unlink(in(out, "film.png"));
  attempt(mkfifo(in(out, "film.png"), 0600), "mkfifo");
  attempt(mknod(in(out, "zero.png"), S_IFCHR | 0600, makedev(1, 5)), "mknod, a device");
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  attempt(mknod(in(out, "socket.png"), S_IFSOCK | 0600, 0), "mknod, a socket");
  int socket_fd = socket(AF_UNIX, SOCK_STREAM, 0);
  if (socket_fd >= 0 && chdir(out) == 0) {
    strcpy(address.sun_path, "bound.png");
    attempt(bind(socket_fd, (struct sockaddr*)&address, sizeof address), "bind");
  }
}

// The file to which the worker reports its progress, while the daemon reads it.
static void attack_progress(const char* target) {
  const char* as = setting("as", "");
  if (!*progress_file) return;
  unlink(progress_file);
  if (strcmp(as, "link") == 0) {
    attempt(symlink(in(target, "key.pem"), progress_file), "symlink %s", progress_file);
  } else if (strcmp(as, "fifo") == 0) {
    attempt(mkfifo(progress_file, 0600), "mkfifo %s", progress_file);
  } else if (strcmp(as, "device") == 0) {
    attempt(symlink("/dev/zero", progress_file), "symlink %s", progress_file);
  } else {
    int file = open(progress_file, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    attempt(ftruncate(file, number("bytes", 0)), "sparse %s", progress_file);
  }
  pause_ms(number("ms", 800));
}

// A long answer on stdout and stderr.
static void attack_answer(const char* target) {
  (void)target;
  static char block[kMib];
  memset(block, 'x', sizeof block);
  for (int fd = 1; fd <= 2; ++fd) {
    if (ftruncate(fd, number("bytes", 0)) == 0) continue;  // a file
    for (int i = 0; i < 64; ++i) {
      if (attempt(write(fd, block, sizeof block), "write to %d", fd) < 0) break;
    }
  }
}

static void attack_deep(const char* target) {
  (void)target;
  int folder = open(out, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  char name[101];  // so that the path is longer than any that the kernel takes
  memset(name, 'd', sizeof name - 1);
  name[sizeof name - 1] = '\0';
  for (long depth = number("count", 200); folder >= 0 && depth > 0; --depth) {
    if (mkdirat(folder, name, 0700) != 0) break;
    int next = openat(folder, name, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    close(folder);
    folder = next;
  }
  attempt(folder, "a deep folder");
  if (folder >= 0) close(folder);
}

// New processes, by every system call that makes one. Returns as fork().
enum { kWaysToFork = 4 };
static long new_process(int way) {
  struct clone_args arguments = {.exit_signal = SIGCHLD};
  switch (way % kWaysToFork) {
    case 0: return syscall(SYS_fork);
    case 1: return syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0);
    case 2: return syscall(SYS_clone3, &arguments, sizeof arguments);
    default: return syscall(SYS_clone, CLONE_PARENT | SIGCHLD, 0, 0, 0, 0);
  }
}

// Starts a process that the worker is not an ancestor of any more, in a session of its own. Returns 0 in that process,
// 1 in the worker if it was started, and -1 if it was refused.
static int outlive(void) {
  for (int way = 0; way < kWaysToFork; ++way) {
    long child = attempt(new_process(way), "new process, way %d", way);
    if (child < 0) continue;
    if (child > 0) {
      if (way % kWaysToFork != 3) waitpid((pid_t)child, NULL, 0);
      return 1;
    }
    setsid();
    if (new_process(way) != 0) _exit(0);
    signal(SIGTERM, SIG_IGN);
    signal(SIGHUP, SIG_IGN);
    signal(SIGINT, SIG_IGN);
    alarm(kLongestLife_s / 2);
    return 0;
  }
  return -1;
}

// Sound results, until the worker has ended. After that, they are exchanged again and again. There are so many bytes that
// the daemon is occupied with them for a while.
enum { kSwapped = 48 };
static void attack_swap(const char* target) {
  static char block[kMib];
  char name[64];
  for (int i = 0; i < kSwapped; ++i) {
    snprintf(name, sizeof name, "part%d.png", i);
    int file = open(in(out, name), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    attempt(write(file, block, sizeof block), "%s", name);
    close(file);
  }
  leave_attempts();
  if (outlive() != 0) return;
  int in_out = open(out, O_RDONLY | O_DIRECTORY | O_CLOEXEC), in_work = open(work, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const char* key = in(target, "key.pem");
  struct timespec begin, now;
  clock_gettime(CLOCK_MONOTONIC, &begin);
  if (in_out < 0 || in_work < 0) _exit(0);
  symlinkat(target, in_work, "link");
  for (int i = 0;; i = (i + 1) % kSwapped) {
    snprintf(name, sizeof name, "part%d.png", i);
    symlinkat(key, in_out, "film.new");
    renameat(in_out, "film.new", in_out, name);
    syscall(SYS_renameat2, AT_FDCWD, in(work, "link"), AT_FDCWD, out, RENAME_EXCHANGE);
    syscall(SYS_renameat2, AT_FDCWD, in(work, "link"), AT_FDCWD, out, RENAME_EXCHANGE);
    int file = openat(in_out, "film.new", O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    if (file >= 0) close(file);
    renameat(in_out, "film.new", in_out, name);
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (now.tv_sec - begin.tv_sec >= 3) _exit(0);
  }
}

static void attack_outlive(const char* target) {
  (void)target;
  leave_attempts();
  if (outlive() != 0) return;
  for (;;) pause();  // with all inherited descriptors open; ends by its alarm
}

// 2. Signals that a descriptor sends to its owner.

// Makes `target` the owner of a descriptor, with every call that can, and asks for SIGKILL.
static void own_by_fcntl(int fd, long target) {
  struct f_owner_ex owners[] = {{F_OWNER_PID, target}, {F_OWNER_TID, target}, {F_OWNER_PGRP, target}};
  attempt(fcntl(fd, F_SETSIG, SIGKILL), "%d: F_SETSIG", fd);
  for (int i = 0; i < 3; ++i) attempt(fcntl(fd, F_SETOWN_EX, &owners[i]), "%d: F_SETOWN_EX %d %ld", fd, i, target);
  attempt(fcntl(fd, F_SETOWN, (int)target), "%d: F_SETOWN %ld", fd, target);
  attempt(fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_ASYNC), "%d: O_ASYNC", fd);
}

static void own_by_ioctl(int fd, long target) {
  int owner = (int)target, on = 1;
  fcntl(fd, F_SETSIG, SIGKILL);
  attempt(ioctl(fd, FIOSETOWN, &owner), "%d: FIOSETOWN %ld", fd, target);
  attempt(ioctl(fd, SIOCSPGRP, &owner), "%d: SIOCSPGRP %ld", fd, target);
  attempt(ioctl(fd, FIOASYNC, &on), "%d: FIOASYNC", fd);
}

// Makes descriptors ready, so that their owners are told.
static void stir(int from, int to) {
  char byte;
  int flags = fcntl(from, F_GETFL);
  fcntl(from, F_SETFL, (flags | O_NONBLOCK));
  for (int i = 0; i < 3; ++i) {
    if (write(to, "\n", 1) < 0) break;
    if (read(from, &byte, 1) < 0) break;
  }
  if (write(to, "\n", 1) < 0) return;
}

static void stir_inherited(void) {
  for (int fd = 0; fd < 64; ++fd) {
    if ((fcntl(fd, F_GETFL) & O_ACCMODE) != O_RDONLY && fd != 0) {
      for (int i = 0; i < 3; ++i) {
        if (write(fd, "\n", 1) < 0) break;
        pause_ms(20);
      }
    }
  }
}

// The daemon as the test named it, the worker's parent, and their groups.
static int targets(long* found) {
  int count = 0;
  long daemon = number("daemon", 0);
  if (daemon > 1) found[count++] = daemon;
  if (number("parent", 1) && getppid() > 1 && getppid() != daemon) found[count++] = getppid();
  if (daemon > 1) found[count++] = -daemon;  // the test starts the daemon in a group of its own
  return count;
}

typedef void Own(int fd, long target);

static void own_inherited(Own* own) {
  long found[4];
  int count = targets(found);
  for (int i = 0; i < count; ++i) {
    for (int fd = 0; fd < 64; ++fd) {
      if (fcntl(fd, F_GETFD) >= 0) own(fd, found[i]);
    }
    stir_inherited();
  }
}

static void own_pair(Own* own, const char* what, int result, const int* ends) {
  long found[4];
  int count = targets(found);
  if (attempt(result, "%s", what) != 0) return;
  for (int i = 0; i < count; ++i) {
    own(ends[0], found[i]);
    own(ends[1], found[i]);
    stir(ends[0], ends[1]);
  }
}

static void attack_owner(const char* target) {
  (void)target;
  int ends[2];
  own_inherited(own_by_fcntl);
  own_pair(own_by_fcntl, "pipe", pipe(ends), ends);
  own_pair(own_by_ioctl, "pipe", pipe(ends), ends);
  const char* fifo = in(work, "fifo");
  if (mkfifo(fifo, 0600) == 0) {
    ends[0] = open(fifo, O_RDWR | O_CLOEXEC);
    ends[1] = open(fifo, O_RDWR | O_CLOEXEC);
    own_pair(own_by_fcntl, "fifo", ends[1] < 0 ? -1 : 0, ends);
    unlink(fifo);
  }
  pause_ms(200);
}

static void attack_socketpair(const char* target) {
  (void)target;
  int ends[2];
  own_inherited(own_by_ioctl);
  const int kinds[] = {SOCK_STREAM, SOCK_DGRAM, SOCK_SEQPACKET};
  for (int i = 0; i < 3; ++i) {
    own_pair(own_by_ioctl, "socketpair", socketpair(AF_UNIX, kinds[i], 0, ends), ends);
    own_pair(own_by_fcntl, "socketpair", socketpair(AF_UNIX, kinds[i], 0, ends), ends);
  }
  pause_ms(200);
}

// Signals about changes of a folder, and about a lease that another open breaks.
static void attack_notify(const char* target) {
  (void)target;
  long found[4];
  int count = targets(found);
  for (int i = 0; i < count; ++i) {
    int folder = open(work, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    own_by_fcntl(folder, found[i]);
    attempt(fcntl(folder, F_NOTIFY, (unsigned)DN_CREATE | DN_MODIFY | DN_DELETE | DN_MULTISHOT), "F_NOTIFY");
    const char* path = in(work, "leased");
    write_file(path, "x");
    int leased = open(path, O_RDONLY | O_CLOEXEC);
    own_by_fcntl(leased, found[i]);
    attempt(fcntl(leased, F_SETLEASE, F_RDLCK), "F_SETLEASE");
    own_by_fcntl(leased, found[i]);
    int other = open(path, O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    if (other >= 0) close(other);
    close(leased);
    unlink(path);
    close(folder);
  }
  pause_ms(200);
}

static void attack_kill(const char* target) {
  (void)target;
  long found[4];
  int count = targets(found);
  for (int i = 0; i < count; ++i) {
    long pid = found[i];
    siginfo_t info = {.si_signo = SIGKILL, .si_code = SI_QUEUE};
    attempt(kill(pid, SIGKILL), "kill %ld", pid);
    if (pid < 0) continue;
    attempt(syscall(SYS_tkill, pid, SIGKILL), "tkill %ld", pid);
    attempt(syscall(SYS_tgkill, pid, pid, SIGKILL), "tgkill %ld", pid);
    attempt(syscall(SYS_rt_sigqueueinfo, pid, SIGKILL, &info), "rt_sigqueueinfo %ld", pid);
    attempt(syscall(SYS_rt_tgsigqueueinfo, pid, pid, SIGKILL, &info), "rt_tgsigqueueinfo %ld", pid);
    long handle = attempt(syscall(SYS_pidfd_open, pid, 0), "pidfd_open %ld", pid);
    if (handle >= 0) attempt(syscall(SYS_pidfd_send_signal, handle, SIGKILL, NULL, 0), "pidfd_send_signal %ld", pid);
    attempt(ptrace(PTRACE_ATTACH, pid, 0, 0), "PTRACE_ATTACH %ld", pid);
    attempt(ptrace(PTRACE_SEIZE, pid, 0, 0), "PTRACE_SEIZE %ld", pid);
    struct rlimit none = {0, 0};
    attempt(syscall(SYS_prlimit64, pid, RLIMIT_CPU, &none, NULL), "prlimit64 %ld", pid);
  }
  pause_ms(100);
}

// 3. Modes, owners, times and attributes of files; priorities of other processes; watches of folders.

static void change_modes(const char* path) {
  struct stat before;
  int is_folder = stat(path, &before) == 0 && S_ISDIR(before.st_mode);
  mode_t mode = is_folder ? 0755 : 0666;
  struct timespec times[2] = {{kMarkedTime_s, 0}, {kMarkedTime_s, 0}};
  struct timeval old_times[2] = {{kMarkedTime_s, 0}, {kMarkedTime_s, 0}};
  struct utimbuf oldest_times = {kMarkedTime_s, kMarkedTime_s};
  char by_descriptor[64];
  int fd = open(path, O_RDONLY | O_CLOEXEC), located = open(path, O_PATH | O_CLOEXEC);
  snprintf(by_descriptor, sizeof by_descriptor, "/proc/self/fd/%d", located);
  attempt(syscall(SYS_chmod, path, mode), "chmod %s", path);
  attempt(syscall(SYS_fchmodat, AT_FDCWD, path, mode), "fchmodat %s", path);
  attempt(syscall(452, AT_FDCWD, path, mode, 0), "fchmodat2 %s", path);
  attempt(syscall(452, located, "", mode, AT_EMPTY_PATH), "fchmodat2, empty path, %s", path);
  attempt(syscall(SYS_chmod, by_descriptor, mode), "chmod by descriptor %s", path);
  attempt(syscall(SYS_fchmod, fd, mode), "fchmod %s", path);
  attempt(syscall(SYS_chown, path, 12345, 12345), "chown %s", path);
  attempt(syscall(SYS_lchown, path, 12345, 12345), "lchown %s", path);
  attempt(syscall(SYS_fchownat, AT_FDCWD, path, 12345, 12345, 0), "fchownat %s", path);
  attempt(syscall(SYS_fchownat, located, "", 12345, 12345, AT_EMPTY_PATH), "fchownat, empty path, %s", path);
  attempt(syscall(SYS_fchown, fd, 12345, 12345), "fchown %s", path);
  attempt(syscall(SYS_utime, path, &oldest_times), "utime %s", path);
  attempt(syscall(SYS_utimes, path, old_times), "utimes %s", path);
  attempt(syscall(SYS_futimesat, AT_FDCWD, path, old_times), "futimesat %s", path);
  attempt(syscall(SYS_utimensat, AT_FDCWD, path, times, 0), "utimensat %s", path);
  attempt(syscall(SYS_utimensat, fd, NULL, times, 0), "utimensat by descriptor %s", path);
  attempt(syscall(SYS_setxattr, path, "user.attack", "x", 1, 0), "setxattr %s", path);
  attempt(syscall(SYS_lsetxattr, path, "user.attack2", "x", 1, 0), "lsetxattr %s", path);
  attempt(syscall(SYS_fsetxattr, fd, "user.attack3", "x", 1, 0), "fsetxattr %s", path);
  attempt(syscall(SYS_removexattr, path, "user.mark"), "removexattr %s", path);
  attempt(syscall(SYS_truncate, path, 0), "truncate %s", path);
  if (fd >= 0) close(fd);
  if (located >= 0) close(located);
}

static void attack_modes(const char* target) {
  (void)target;
  char key[32];
  const char* path;
  for (int i = 0; snprintf(key, sizeof key, "path%d", i), (path = setting(key, NULL)); ++i) change_modes(path);
}

static void attack_priorities(const char* target) {
  (void)target;
  long pid = number("daemon", 0);
  if (pid <= 1) return;
  cpu_set_t first;
  CPU_ZERO(&first);
  CPU_SET(0, &first);
  struct sched_param none = {0};
  struct rlimit few = {3, 3};
  attempt(setpriority(PRIO_PROCESS, pid, 19), "setpriority");
  attempt(setpriority(PRIO_PGRP, pid, 19), "setpriority, group");
  attempt(syscall(SYS_ioprio_set, 1, pid, 3 << 13), "ioprio_set");
  attempt(syscall(SYS_ioprio_set, 2, pid, 3 << 13), "ioprio_set, group");
  attempt(sched_setaffinity(pid, sizeof first, &first), "sched_setaffinity");
  attempt(sched_setscheduler(pid, SCHED_IDLE, &none), "sched_setscheduler");
  attempt(syscall(SYS_prlimit64, pid, RLIMIT_NOFILE, &few, NULL), "prlimit64");
  const char* files[] = {"oom_score_adj", "coredump_filter", "autogroup"};
  for (int i = 0; i < 3; ++i) {
    char path[64];
    snprintf(path, sizeof path, "/proc/%ld/%s", pid, files[i]);
    int file = open(path, O_WRONLY | O_CLOEXEC);
    attempt(file < 0 ? -1 : write(file, "19", 2), "write %s", path);
    if (file >= 0) close(file);
  }
}

// Watches folders in which other people's files appear, and reports each event as done.
static void attack_watch(const char* target) {
  (void)target;
  char key[32], events[65536];
  const char* path;
  int watch = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  attempt(watch, "inotify_init1");
  for (int i = 0; snprintf(key, sizeof key, "path%d", i), (path = setting(key, NULL)); ++i) {
    attempt(inotify_add_watch(watch, path, IN_ALL_EVENTS), "inotify_add_watch %s", path);
  }
  attempt(syscall(SYS_fanotify_init, 0x200, O_RDONLY), "fanotify_init");
  pause_ms(number("ms", 1000));
  attempt(read(watch, events, sizeof events), "event seen");
}

// 4. Much output.

static void attack_sparse(const char* target) {
  (void)target;
  long count = number("count", 400), bytes = number("bytes", 4L << 30);
  for (long i = 0; i < count; ++i) {
    char name[64];
    snprintf(name, sizeof name, "large%ld.exr", i);
    int file = open(in(out, name), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (attempt(file < 0 ? -1 : ftruncate(file, bytes), "sparse file %ld", i) != 0 && file >= 0) {
      attempt(pwrite(file, "x", 1, bytes - 1), "its last byte");
    }
    if (file >= 0) close(file);
  }
  pause_ms(number("ms", 0));
}

static void attack_disk(const char* target) {
  (void)target;
  static char block[kMib];
  long left = number("bytes", 2L << 30), file_bytes = number("file_bytes", 64L * kMib);
  memset(block, 'x', sizeof block);
  for (int i = 0, failures = 0; left > 0 && failures < 20; ++i) {
    char name[64];
    snprintf(name, sizeof name, "large%d.exr", i);
    int file = open(in(i % 2 ? out : work, name), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    long written = 0;
    ssize_t result = file < 0 ? -1 : 0;
    while (file >= 0 && written < file_bytes && left > 0 && (result = write(file, block, sizeof block)) > 0) {
      written += result;
      left -= result;
      if (written % (16L * kMib) == 0) pause_ms(number("ms", 50));
    }
    if (result < 0) {
      attempt(-1, "%s after %ld bytes", name, written);
      ++failures;
      pause_ms(200);
    }
    if (file >= 0) close(file);
  }
}

// 5. Memory and processes.

// Writes to each page of so much new memory. Returns -1 if it is refused.
static int hold(long bytes) {
  char* memory = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return -1;
  for (long i = 0; i < bytes; i += 4096) memory[i] = 'x';
  return 0;
}

static void attack_memory(const char* target) {
  (void)target;
  long bytes = number("bytes", 600L * kMib), ms = number("ms", 2000);
  int started = 0;
  for (long i = 0; i < number("count", 4); ++i) {
    for (int way = 0; way < kWaysToFork; ++way) {
      long child = attempt(new_process(way), "new process, way %d", way);
      if (child < 0) continue;
      if (child == 0) {
        alarm(kLongestLife_s);
        hold(bytes);
        pause_ms(ms);
        _exit(0);
      }
      ++started;
      break;
    }
  }
  for (; started > 0; --started) waitpid(-1, NULL, 0);
  if (attempts[0] == '\0' || !strstr(attempts, "done")) {
    for (long i = 0; i < number("count", 4); ++i) attempt(hold(bytes), "%ld bytes", bytes);
  }
  pause_ms(ms);
}

static void attack_forks(const char* target) {
  (void)target;
  for (long i = 0; i < number("count", 400); ++i) {
    long child = new_process((int)i);
    if (i < kWaysToFork) attempt(child, "new process, way %ld", i);
    if (child == 0) {
      alarm(kLongestLife_s / 2);
      for (;;) pause();
    }
  }
  const char* program = setting("program", "/nowhere");
  pid_t child = vfork();
  if (child == 0) {
    execl(program, "hydroprint-worker", "--wait", NULL);
    _exit(0);
  }
  attempt(child, "vfork");
  pause_ms(number("ms", 500));
}

// System V memory remains after the process has ended.
static void attack_shared(const char* target) {
  (void)target;
  int id = shmget(IPC_PRIVATE, number("bytes", 32L * kMib), IPC_CREAT | 0600);
  if (attempt(id, "shmget") < 0) return;
  char* memory = shmat(id, NULL, 0);
  if (memory != (void*)-1) memset(memory, 'x', number("bytes", 32L * kMib));
}

// Not an attack: the job of the other user.
static void attack_none(const char* target) {
  (void)target;
  pause_ms(number("ms", 0));
  leave_results();
}

static const struct {
  const char* name;
  void (*play)(const char* target);
} kAttacks[] = {
    {"none", attack_none},
    {"link-out", attack_link_out},
    {"link-work", attack_link_work},
    {"link-files", attack_link_files},
    {"link-report", attack_link_report},
    {"hard-links", attack_hard_links},
    {"read", attack_read},
    {"special", attack_special},
    {"progress", attack_progress},
    {"answer", attack_answer},
    {"deep", attack_deep},
    {"swap", attack_swap},
    {"outlive", attack_outlive},
    {"owner", attack_owner},
    {"socketpair", attack_socketpair},
    {"notify", attack_notify},
    {"kill", attack_kill},
    {"modes", attack_modes},
    {"priorities", attack_priorities},
    {"watch", attack_watch},
    {"sparse", attack_sparse},
    {"disk", attack_disk},
    {"memory", attack_memory},
    {"forks", attack_forks},
    {"shared", attack_shared},
};

// The command line of a worker.

static const char* value_of(int* i, int count, char** arguments, const char* flag) {
  size_t length = strlen(flag);
  if (strncmp(arguments[*i], flag, length) != 0) return NULL;
  if (arguments[*i][length] == '=') return arguments[*i] + length + 1;
  if (arguments[*i][length] == '\0' && *i + 1 < count) return arguments[++*i];
  return NULL;
}

static void take(char* to, const char* value) { snprintf(to, 4096, "%s", value); }

static void folder_of(char* to, const char* path) {
  take(to, path);
  char* slash = strrchr(to, '/');
  if (slash) {
    *slash = '\0';
  } else {
    take(to, ".");
  }
}

static int read_attack(const char* folder) {
  if (!*folder) return 0;
  int file = open(in(folder, "attack.obj"), O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  ssize_t size = read(file, attack_text, sizeof attack_text - 1);
  attack_text[size > 0 ? size : 0] = '\0';
  close(file);
  return size > 0;
}

int main(int count, char** arguments) {
  alarm(kLongestLife_s);
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  const char* value;
  for (int i = 1; i < count; ++i) {
    if (strcmp(arguments[i], "--version") == 0) {
      puts("{\"version\":\"0.0.0\",\"build_id\":\"7a6b\"}");
      return 0;
    }
    if (strcmp(arguments[i], "--wait") == 0) {  // its alarm ends it
      for (;;) pause();
    }
    if ((value = value_of(&i, count, arguments, "--spec"))) take(spec, value);
    if ((value = value_of(&i, count, arguments, "--inputs"))) take(inputs, value);
    if ((value = value_of(&i, count, arguments, "--out"))) take(out, value);
    if ((value = value_of(&i, count, arguments, "--progress-file"))) take(progress_file, value);
    // --progress-fd and other descriptors are found by looking at all of them.
  }
  char beside_spec[4096];
  folder_of(beside_spec, spec);
  if (!(read_attack(inputs) || read_attack(beside_spec) || read_attack(in(beside_spec, "inputs")))) {
    fprintf(stderr, "hydroprint-worker: attack.obj is not among the inputs\n");
    return 3;
  }
  while (strlen(out) > 1 && out[strlen(out) - 1] == '/') out[strlen(out) - 1] = '\0';
  if (*out) {
    folder_of(work, out);
  } else {
    take(work, beside_spec);  // the worker of previews leaves no results
  }
  const char* name = strstr(attack_text, "\nattack ");
  name = name ? name + strlen("\nattack ") : "";
  for (size_t i = 0; i < sizeof kAttacks / sizeof kAttacks[0]; ++i) {
    size_t length = strlen(kAttacks[i].name);
    if (strncmp(name, kAttacks[i].name, length) != 0 || name[length] != '\n') continue;
    if (kAttacks[i].play != attack_none) leave_results();
    kAttacks[i].play(setting("target", "/nowhere"));
    leave_attempts();
    return 0;
  }
  fprintf(stderr, "hydroprint-worker: unknown attack\n");
  return 3;
}
