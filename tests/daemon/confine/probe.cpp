// A program that tries what a confined program may and may not do, and prints the outcomes.
//
//   daemon_confine_probe ACTION [ARGUMENT] ...
//
//   read FILE      reads the first byte of a file
//   write FILE     appends a byte to a file
//   list DIR       lists a folder
//   truncate FILE  empties a file by name
//   empty FILE     empties a file by opening it, but not for writing
//   move FILE      renames FILE to FILE.moved
//   socket x       opens sockets of several families
//   self x         signals a thread of this process
//   signal PID     signals another process in each way that Linux has
//   limits PID     reads limits of another process and of this one
//   grow MIB       allocates and fills memory
//   echo FD        copies the bytes of a descriptor to stdout
//   open x         lists the open descriptors
//   refused FILE   tries each call that is refused
//   missing FILE   tries each call that does not exist for confined programs
//   needed DIR     uses what the libraries of workers need
//   interface I    makes a call of the binary interface "i386" or "x32"
//   arguments ...  prints all further arguments, one a line
//
// Each outcome is a line "ACTION: yes" or "ACTION: REASON".

#include <dirent.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <iostream>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "tests/daemon/confine/probe_calls.h"

namespace {

volatile std::sig_atomic_t signals = 0;

void count_signal(int) { signals = signals + 1; }

void read_byte(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY);
  char byte = 0;
  print("read", file >= 0 && ::read(file, &byte, 1) == 1);
}

void write_byte(const std::string& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  print("write", file >= 0 && ::write(file, "x", 1) == 1);
}

void empty(const std::string& path) {
  print("O_RDONLY", ::open(path.c_str(), O_RDONLY | O_TRUNC) >= 0);
  print("mode 3", ::open(path.c_str(), O_ACCMODE | O_TRUNC) >= 0);
  // The kernel ignores the upper half of the flags.
  print("by long flags", ::syscall(SYS_open, path.c_str(), O_TRUNC | (1L << 32)) >= 0);
}

void open_sockets() {
  print("inet", ::socket(AF_INET, SOCK_STREAM, 0) >= 0);
  print("unix", ::socket(AF_UNIX, SOCK_STREAM, 0) >= 0);
  print("netlink", ::socket(AF_NETLINK, SOCK_RAW, 0) >= 0);
  print("io_uring", ::syscall(SYS_io_uring_setup, 1, nullptr) >= 0);
}

void signal_own_thread() {
  std::signal(SIGUSR1, count_signal);
  std::atomic<pid_t> id = 0;
  std::atomic<bool> end = false;
  std::thread thread([&] {
    id = static_cast<pid_t>(::syscall(SYS_gettid));
    while (!end) ::usleep(100);
  });
  while (id == 0) ::usleep(100);
  siginfo_t info{};
  info.si_code = SI_QUEUE;
  info.si_signo = SIGUSR1;
  print("tgkill own thread", ::syscall(SYS_tgkill, ::getpid(), id.load(), SIGUSR1) == 0);
  print("queue to own thread",
        ::syscall(SYS_rt_tgsigqueueinfo, ::getpid(), id.load(), SIGUSR1, &info) == 0);
  print("raise", ::raise(SIGUSR1) == 0);
  end = true;
  thread.join();
  print("signals arrive", signals >= 2);
}

// Uses signal 0, which arrives nowhere, but needs the same right.
void signal_process(pid_t id) {
  siginfo_t info{};
  info.si_code = SI_QUEUE;
  // The kernel ignores the upper half of a process id, which a filter may compare.
  const long id_with_upper_half = static_cast<long>(id) | (1L << 32);
  print("kill", ::kill(id, 0) == 0);
  print("tkill", ::syscall(SYS_tkill, id, 0) == 0);
  print("tgkill", ::syscall(SYS_tgkill, id, id, 0) == 0);
  print("tgkill by long id", ::syscall(SYS_tgkill, id_with_upper_half, id, 0) == 0);
  print("queue", ::syscall(SYS_rt_sigqueueinfo, id, 0, &info) == 0);
  print("queue to thread", ::syscall(SYS_rt_tgsigqueueinfo, id, id, 0, &info) == 0);
  print("pidfd", ::syscall(SYS_pidfd_open, id, 0) >= 0);
  print("group", ::kill(0, 0) == 0);
}

void read_limits(pid_t id) {
  rlimit limits{};
  print("read limits", ::prlimit(id, RLIMIT_NOFILE, nullptr, &limits) == 0);
  print("own limits", ::getrlimit(RLIMIT_NOFILE, &limits) == 0);
}

void grow(int mib) {
  constexpr std::size_t kMiB = 1 << 20;
  bool succeeded = true;
  try {
    std::vector<std::vector<char>> blocks;
    for (int i = 0; i < mib; ++i) blocks.emplace_back(kMiB, 'x');
  } catch (const std::bad_alloc&) {
    errno = ENOMEM;
    succeeded = false;
  }
  print("grow", succeeded);
}

void echo(int from) {
  char bytes[256];
  for (ssize_t count = 0; (count = ::read(from, bytes, sizeof bytes)) > 0;) {
    if (::write(1, bytes, static_cast<std::size_t>(count)) != count) return;
  }
}

void list_open() {
  std::cout << "open:";
  for (int i = 0; i < 1024; ++i) {
    if (::fcntl(i, F_GETFD) >= 0) std::cout << ' ' << i;
  }
  std::cout << std::endl;
}

void perform(const std::string& action, const std::string& argument) {
  if (action == "read") read_byte(argument);
  if (action == "write") write_byte(argument);
  if (action == "list") print(action, ::opendir(argument.c_str()) != nullptr);
  if (action == "truncate") print(action, ::truncate(argument.c_str(), 0) == 0);
  if (action == "empty") empty(argument);
  if (action == "refused") try_refused_calls(argument);
  if (action == "missing") try_missing_calls(argument);
  if (action == "needed") use_needed_calls(argument);
  if (action == "interface") call_as(argument);
  if (action == "move") {
    print(action, ::rename(argument.c_str(), (argument + ".moved").c_str()) == 0);
  }
  if (action == "socket") open_sockets();
  if (action == "self") signal_own_thread();
  if (action == "signal") signal_process(std::stoi(argument));
  if (action == "limits") read_limits(std::stoi(argument));
  if (action == "grow") grow(std::stoi(argument));
  if (action == "echo") echo(std::stoi(argument));
  if (action == "open") list_open();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "arguments") {
    for (int i = 2; i < argc; ++i) std::cout << argv[i] << '\n';
    return 0;
  }
  for (int i = 1; i + 1 < argc; i += 2) perform(argv[i], argv[i + 1]);
}
