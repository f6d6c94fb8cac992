#include "tests/daemon/confine/probe_calls.h"

#include <fcntl.h>
#include <linux/fs.h>
#include <linux/sockios.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/msg.h>
#include <sys/prctl.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/timerfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <iostream>
#include <thread>
#include <vector>

void print(const std::string& action, bool succeeded) {
  std::cout << action << ": " << (succeeded ? "yes" : std::strerror(errno)) << std::endl;
}

namespace {

constexpr std::size_t kPage = 4096;

struct NamedCall {
  const char* name;
  long number;
};

struct NamedValue {
  const char* name;
  unsigned long value;
};

// Calls that take the name of a file first; the other arguments are 0, which is harmless.
void change_named_file(const char* path) {
  constexpr std::array kCalls{
      NamedCall{"setxattr", SYS_setxattr},         NamedCall{"lsetxattr", SYS_lsetxattr},
      NamedCall{"removexattr", SYS_removexattr},   NamedCall{"utime", SYS_utime},
      NamedCall{"lremovexattr", SYS_lremovexattr}, NamedCall{"utimes", SYS_utimes},
  };
  for (const auto& [name, number] : kCalls) {
    print(name, ::syscall(number, path, "user.x", nullptr, 0, 0) == 0);
  }
  print("chmod", ::syscall(SYS_chmod, path, 0600) == 0);
  print("chown", ::syscall(SYS_chown, path, ::getuid(), ::getgid()) == 0);
  print("lchown", ::syscall(SYS_lchown, path, ::getuid(), ::getgid()) == 0);
}

void change_file(const std::string& path) {
  const char* const name = path.c_str();
  change_named_file(name);
  const int file = ::open(name, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  print("fchmod", ::fchmod(file, 0600) == 0);
  print("fchown", ::fchown(file, ::getuid(), ::getgid()) == 0);
  print("fsetxattr", ::syscall(SYS_fsetxattr, file, "user.x", nullptr, 0, 0) == 0);
  print("fremovexattr", ::syscall(SYS_fremovexattr, file, "user.x") == 0);
  print("fchmodat", ::fchmodat(AT_FDCWD, name, 0600, 0) == 0);
  print("fchownat", ::fchownat(AT_FDCWD, name, ::getuid(), ::getgid(), 0) == 0);
  print("futimesat", ::syscall(SYS_futimesat, AT_FDCWD, name, nullptr) == 0);
  print("utimensat", ::utimensat(AT_FDCWD, name, nullptr, 0) == 0);
  print("futimens", ::futimens(file, nullptr) == 0);
  ::close(file);
}

void watch_files() {
  print("inotify_init", ::syscall(SYS_inotify_init) >= 0);
  print("inotify_init1", ::syscall(SYS_inotify_init1, 0) >= 0);
  print("inotify_add_watch", ::syscall(SYS_inotify_add_watch, 0, "/", 1) >= 0);
  print("fanotify_init", ::syscall(SYS_fanotify_init, 0x200, 0) >= 0);  // FAN_REPORT_FID
}

void share_memory() {
  std::array<int, 2> ends{};
  print("socketpair", ::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0);
  const int shared = ::shmget(IPC_PRIVATE, kPage, 0600);
  print("shmget", shared >= 0);
  print("shmat", ::syscall(SYS_shmat, shared, nullptr, 0) != -1);
  print("shmctl", ::shmctl(shared, IPC_RMID, nullptr) == 0);
  const int semaphore = ::semget(IPC_PRIVATE, 1, 0600);
  print("semget", semaphore >= 0);
  print("semctl", ::semctl(semaphore, 0, IPC_RMID) == 0);
  const int queue = ::msgget(IPC_PRIVATE, 0600);
  print("msgget", queue >= 0);
  print("msgctl", ::msgctl(queue, IPC_RMID, nullptr) == 0);
  print("mq_open", ::syscall(SYS_mq_open, "hydroprint-probe", O_RDONLY, 0, nullptr) >= 0);
  print("memfd_create", ::syscall(SYS_memfd_create, "x", 0) >= 0);
  print("shared memory",
        ::mmap(nullptr, kPage, PROT_READ, MAP_SHARED | MAP_ANONYMOUS, -1, 0) != MAP_FAILED);
}

int exit_thread(void*) {
  ::syscall(SYS_exit, 0);
  return 0;
}

// Ends a process that was started. Returns whether this is the parent, which has one more child.
bool has_started(long child) {
  if (child == 0) ::_exit(0);
  if (child > 0) ::waitpid(static_cast<pid_t>(child), nullptr, 0);
  return child > 0;
}

void start_processes() {
  print("fork", has_started(::fork()));
  print("SYS_fork", has_started(::syscall(SYS_fork)));
  const pid_t child = ::vfork();  // NOLINT(clang-analyzer-security.insecureAPI.vfork): is tried
  if (child == 0) ::_exit(0);
  print("vfork", has_started(child));
  print("clone by long flags",
        has_started(::syscall(SYS_clone, SIGCHLD | (0x10000L << 32), 0, 0, 0, 0)));
  constexpr std::array kNamespaces{
      NamedValue{"new mounts", CLONE_NEWNS},   NamedValue{"new cgroup", CLONE_NEWCGROUP},
      NamedValue{"new names", CLONE_NEWUTS},   NamedValue{"new IPC", CLONE_NEWIPC},
      NamedValue{"new users", CLONE_NEWUSER},  NamedValue{"new processes", CLONE_NEWPID},
      NamedValue{"new network", CLONE_NEWNET},
  };
  alignas(16) static std::array<char, 16 * kPage> stack;
  constexpr int kThread = CLONE_VM | CLONE_SIGHAND | CLONE_THREAD;
  for (const auto& [name, flag] : kNamespaces) {
    print(name, ::clone(exit_thread, stack.data() + stack.size(), kThread | static_cast<int>(flag),
                        nullptr) > 0);
  }
}

// Tries a command also with an upper half, which the kernel ignores.
void try_commands(long call, int file, const std::vector<NamedValue>& commands, long argument) {
  for (const auto& [name, command] : commands) {
    print(name, ::syscall(call, file, command, argument) == 0);
    print(name + std::string(" by long command"),
          ::syscall(call, file, command | (1UL << 32), argument) == 0);
  }
}

void steer_signals(const std::string& path) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) print("pipe", false);
  const std::array<int, 2> own{1, ::getpid()};  // F_OWNER_PID
  try_commands(SYS_fcntl, ends[0], {{"F_SETOWN_EX", F_SETOWN_EX}},
               reinterpret_cast<long>(own.data()));
  try_commands(SYS_fcntl, ends[0],
               {{"F_SETOWN", F_SETOWN}, {"F_SETSIG", F_SETSIG}, {"F_SETPIPE_SZ", F_SETPIPE_SZ}}, 0);
  try_commands(SYS_fcntl, ends[0], {{"O_ASYNC", F_SETFL}}, O_ASYNC | O_NONBLOCK);
  int none = 0;
  try_commands(SYS_ioctl, ends[0],
               {{"FIOASYNC", FIOASYNC},
                {"FIOSETOWN", FIOSETOWN},
                {"SIOCSPGRP", SIOCSPGRP},
                {"TIOCSTI", TIOCSTI},
                {"TIOCLINUX", TIOCLINUX}},
               reinterpret_cast<long>(&none));
  const int file = ::open(path.c_str(), O_RDONLY | O_CREAT | O_CLOEXEC, 0600);
  try_commands(SYS_fcntl, file, {{"F_SETLEASE", F_SETLEASE}}, F_RDLCK);
  try_commands(SYS_fcntl, file, {{"F_NOTIFY", F_NOTIFY}}, 0);
  std::array<long, 8> zero{};
  try_commands(SYS_ioctl, file,
               {{"FS_IOC_SETFLAGS", FS_IOC_SETFLAGS},
                {"FS_IOC_FSSETXATTR", FS_IOC_FSSETXATTR},
                {"FS_IOC_RESVSP", 0x40305828},
                {"FS_IOC_RESVSP64", 0x4030582a},
                {"FS_IOC_ZERO_RANGE", 0x40305839}},
               reinterpret_cast<long>(zero.data()));
  ::close(file);
}

void touch_others() {
  cpu_set_t cores;
  ::sched_getaffinity(0, sizeof cores, &cores);
  print("sched_setaffinity", ::sched_setaffinity(::getppid(), sizeof cores, &cores) == 0);
  print("ioprio_set", ::syscall(SYS_ioprio_set, 1, 0, 0) == 0);
  for (const auto& [name, option] :
       {NamedValue{"PR_SET_PDEATHSIG", PR_SET_PDEATHSIG}, {"PR_SET_DUMPABLE", PR_SET_DUMPABLE}}) {
    print(name, ::syscall(SYS_prctl, option | (1UL << 32), 0, 0, 0, 0) == 0);
  }
}

void use_threads() {
  cpu_set_t cores;
  print("cores", ::sched_getaffinity(0, sizeof cores, &cores) == 0 &&
                     ::sched_setaffinity(0, sizeof cores, &cores) == 0);
  print("cores of a thread", ::pthread_getaffinity_np(::pthread_self(), sizeof cores, &cores) == 0);
  std::atomic<int> count = 0;
  std::array<std::thread, 8> threads;
  for (std::thread& thread : threads) thread = std::thread([&count] { ++count; });
  for (std::thread& thread : threads) thread.join();
  print("threads", count == 8);
  print("name", ::pthread_setname_np(::pthread_self(), "probe") == 0);
  print("yield", ::sched_yield() == 0);
}

void use_memory(int file) {
  void* const memory =
      ::mmap(nullptr, 16 * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  print("memory", memory != MAP_FAILED && ::madvise(memory, kPage, MADV_DONTNEED) == 0);
  void* const moved = ::mremap(memory, 16 * kPage, 32 * kPage, MREMAP_MAYMOVE);
  print("mremap", moved != MAP_FAILED && ::mprotect(moved, kPage, PROT_READ) == 0);
  print("shared file",
        ::mmap(nullptr, kPage, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0) != MAP_FAILED);
  char byte = 0;
  print("random numbers", ::getrandom(&byte, 1, 0) == 1);
}

void use_time_and_events() {
  const timespec soon{0, 1000};
  print("sleep", ::clock_nanosleep(CLOCK_MONOTONIC, 0, &soon, nullptr) == 0);
  timer_t timer{};
  sigevent event{};
  event.sigev_notify = SIGEV_NONE;
  print("timer", ::timer_create(CLOCK_MONOTONIC, &event, &timer) == 0);
  print("timerfd", ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC) >= 0);
  print("eventfd", ::eventfd(0, EFD_CLOEXEC) >= 0);
  rlimit limits{};
  print("own limits",
        ::getrlimit(RLIMIT_CORE, &limits) == 0 && ::setrlimit(RLIMIT_CORE, &limits) == 0);
}

void use_files(const std::string& folder, int file) {
  const std::string sub = folder + "/sub", link = sub + "/link", name = sub + "/file";
  struct flock lock {};
  lock.l_type = F_WRLCK;
  int unread = 0;
  print("posix_fallocate", (errno = ::posix_fallocate(file, 0, 2 * kPage)) == 0);
  print("ftruncate", ::ftruncate(file, kPage) == 0 && ::fsync(file) == 0);
  print("lock", ::fcntl(file, F_SETLK, &lock) == 0);
  print("flags",
        ::fcntl(file, F_SETFL, O_NONBLOCK) == 0 && ::fcntl(file, F_SETFD, FD_CLOEXEC) == 0);
  print("ioctl", ::ioctl(file, FIONREAD, &unread) == 0);
  print("mkdir", ::mkdir(sub.c_str(), 0700) == 0);
  print("rename", ::rename((folder + "/new").c_str(), name.c_str()) == 0);
  print("symlink", ::symlink("file", link.c_str()) == 0);
  print("overwrite", ::open(name.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC) >= 0);
  print("remove",
        ::unlink(link.c_str()) == 0 && ::unlink(name.c_str()) == 0 && ::rmdir(sub.c_str()) == 0);
}

}  // namespace

void try_refused_calls(const std::string& file) {
  ::close(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  change_file(file);
  watch_files();
  share_memory();
  start_processes();
  steer_signals(file);
  touch_others();
}

void try_missing_calls(const std::string& file) {
  const int open_file = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  constexpr long kFchmodat2 = 452, kSetxattrat = 463;
  print("clone3", ::syscall(SYS_clone3, nullptr, 0) == 0);
  print("openat2", ::syscall(SYS_openat2, AT_FDCWD, file.c_str(), nullptr, 0) == 0);
  print("fchmodat2", ::syscall(kFchmodat2, AT_FDCWD, file.c_str(), 0600, 0) == 0);
  print("setxattrat", ::syscall(kSetxattrat, AT_FDCWD, file.c_str(), 0, "user.x", nullptr, 0) == 0);
  print("fallocate", ::fallocate(open_file, 0, 0, kPage) == 0);
}

void use_needed_calls(const std::string& folder) {
  const int file = ::open((folder + "/new").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  use_threads();
  use_files(folder, file);
  use_memory(file);
  use_time_and_events();
}

void call_as(const std::string& interface) {
  constexpr long kX32 = 0x40000000;
  if (interface == "x32") print(interface, ::syscall(kX32 | SYS_getpid) > 0);
#ifdef __x86_64__
  long result = 20;  // getpid
  if (interface == "i386") asm volatile("int $0x80" : "+a"(result) : : "memory");
  if (interface == "i386") print(interface, result > 0);
#endif
}
