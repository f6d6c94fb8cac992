#pragma once

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace hydroprint::testing {

/// A kernel that refuses some system calls.
class KernelWithout {
 public:
  /// @param error       errno of the refused calls
  /// @param also_prctl  true: prctl(PR_SET_SECCOMP) is refused, too
  KernelWithout(const std::vector<long>& calls, int error, bool also_prctl = false) {
    const std::uint32_t refusal = SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error);
    add(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
    for (const long call : calls) {
      add(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1);
      add(BPF_RET | BPF_K, refusal);
    }
    if (also_prctl) {
      add(BPF_JMP | BPF_JEQ | BPF_K, SYS_prctl, 0, 3);
      add(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[0]));
      add(BPF_JMP | BPF_JEQ | BPF_K, PR_SET_SECCOMP, 0, 1);
      add(BPF_RET | BPF_K, refusal);
    }
    add(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  }

  /// Calls a function on this kernel; programs that it starts run on it, too. The function runs in
  /// a thread of its own, because the kernel cannot be changed back.
  template <class Function>
  auto call(Function function) const {
    decltype(function()) result{};
    bool is_installed = false;
    std::thread([&] {
      const sock_fprog program{static_cast<unsigned short>(rules_.size()),
                               const_cast<sock_filter*>(rules_.data())};
      is_installed = ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                     ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
      if (is_installed) result = function();
    }).join();
    if (!is_installed) throw std::runtime_error("the test's filter cannot be installed");
    return result;
  }

 private:
  void add(unsigned code, std::uint32_t value, std::uint8_t if_true = 0,
           std::uint8_t if_false = 0) {
    rules_.push_back({static_cast<std::uint16_t>(code), if_true, if_false, value});
  }

  std::vector<sock_filter> rules_;
};

}  // namespace hydroprint::testing
