// main() of timing tests, which use drives with timeouts of 0.1 s. If the machine stalls during a
// test, a failure means nothing. The program then prints the delay and runs the tests again. A
// failure in the third try counts, even if the machine was late again.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace hydroprint::testing {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kTry = "HYDROPRINT_TEST_TRY";
constexpr const char* kLate_ms = "HYDROPRINT_TEST_LATE_MS";  // smallest delay of the tries before
constexpr int kTries = 3;
/// Between late tries, because delays come in phases, such as while the kernel writes files back.
constexpr std::chrono::seconds kPause(10);
// Largest delay of a machine that keeps time; less than the tolerance of any of these tests.
constexpr double kTolerated_s = 0.02;
constexpr int kWatchedProcessors = 8;
constexpr std::chrono::milliseconds kInterval{2};
constexpr std::chrono::milliseconds kSampleInterval{50};

using Waits = std::map<pid_t, double>;

/// Adds the seconds for which each thread of a process and of its descendants has waited for a core
/// since its start, by thread id. Leaves out threads of lower priority, which compute and may wait.
/// Adds nothing on kernels that do not show this.
void add_waits(const std::string& pid, Waits& waits) {
  std::error_code error;  // threads may end at any time
  std::filesystem::directory_iterator task("/proc/" + pid + "/task", error);
  for (; !error && task != std::filesystem::directory_iterator(); task.increment(error)) {
    const std::filesystem::path folder = task->path();
    const pid_t thread = std::atoi(folder.filename().c_str());
    double ran_ns = 0, waited_ns = 0;
    if (std::ifstream(folder / "schedstat") >> ran_ns >> waited_ns &&
        ::getpriority(PRIO_PROCESS, static_cast<id_t>(thread)) <= 0) {
      waits[thread] = waited_ns / 1e9;
    }
    std::ifstream children(folder / "children");
    for (std::string child; children >> child;) add_waits(child, waits);
  }
}

/// Both ends of a pseudo-terminal.
class Terminal {
 public:
  Terminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    std::array<char, 128> name{};
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
        ::ptsname_r(master_, name.data(), name.size()) != 0)
      return;
    slave_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios settings{};
    ::tcgetattr(slave_, &settings);
    ::cfmakeraw(&settings);
    ::tcsetattr(slave_, TCSANOW, &settings);
  }
  ~Terminal() {
    if (slave_ >= 0) ::close(slave_);
    if (master_ >= 0) ::close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  [[nodiscard]] bool is_open() const { return slave_ >= 0; }

  /// Writes a byte and reads it at the other end.
  [[nodiscard]] bool pass_byte() const {
    char byte = 'x';
    return ::write(master_, &byte, 1) == 1 && ::read(slave_, &byte, 1) == 1;
  }

 private:
  int master_;
  int slave_ = -1;
};

/// Measures the largest delay of many short sleeps, on up to kWatchedProcessors processors, and the
/// longest wait of this process and its descendants for a core, and of a byte in a pseudo-terminal.
/// The former also shows that a virtual machine stalls, the latter that other programs delay the
/// rig or the daemon.
class DelayMeter {
 public:
  DelayMeter() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
    for (int cpu = 0; cpu < CPU_SETSIZE && std::ssize(watches_) < kWatchedProcessors; ++cpu) {
      if (CPU_ISSET(cpu, &allowed)) watches_.emplace_back([this, cpu] { watch(cpu); });
    }
    watches_.emplace_back([this] { watch_waits(); });
    watches_.emplace_back([this] { watch_terminal(); });
  }
  ~DelayMeter() { (void)end(); }
  DelayMeter(const DelayMeter&) = delete;
  DelayMeter& operator=(const DelayMeter&) = delete;

  /// Ends the measurement and returns the largest delay.
  double end() {
    end_ = true;
    for (std::thread& each : watches_) each.join();
    watches_.clear();
    return worst_s_;
  }

 private:
  void watch(int cpu) {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(cpu, &one);
    ::pthread_setaffinity_np(::pthread_self(), sizeof one, &one);
    while (!end_) {
      const Clock::time_point due = Clock::now() + kInterval;
      std::this_thread::sleep_until(due);
      note(std::chrono::duration<double>(Clock::now() - due).count());
    }
  }

  void watch_waits() {
    Waits before;
    const auto sample = [&] {
      Waits now;
      add_waits("self", now);
      for (const auto& [thread, waited_s] : now) note(waited_s - before[thread]);
      before = std::move(now);
    };
    for (add_waits("self", before); !end_; std::this_thread::sleep_for(kSampleInterval)) sample();
    sample();
  }

  /// Measures how long a byte takes through a pseudo-terminal, because threads of the kernel carry
  /// it, as they carry the bytes of a simulated serial line.
  void watch_terminal() {
    Terminal terminal;
    while (terminal.is_open() && !end_) {
      const Clock::time_point sent = Clock::now();
      if (!terminal.pass_byte()) return;
      note(std::chrono::duration<double>(Clock::now() - sent).count());
      std::this_thread::sleep_for(kInterval);
    }
  }

  void note(double late_s) {
    double worst_s = worst_s_;
    while (late_s > worst_s && !worst_s_.compare_exchange_weak(worst_s, late_s)) {
    }
  }

  std::atomic<bool> end_ = false;
  std::atomic<double> worst_s_ = 0;
  std::vector<std::thread> watches_;
};

int number_in(const char* variable, int otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::atoi(text);
}

}  // namespace
}  // namespace hydroprint::testing

int main(int argc, char** argv) {
  using namespace hydroprint::testing;
  std::vector<char*> again(argv, argv + argc);
  again.push_back(nullptr);
  ::testing::InitGoogleTest(&argc, argv);
  if (GTEST_FLAG_GET(list_tests)) return RUN_ALL_TESTS();
  DelayMeter meter;
  const int result = RUN_ALL_TESTS();
  const double late_s = meter.end();
  const int next = number_in(kTry, 0) + 1;
  if (result == 0 || late_s < kTolerated_s) return result;
  const int late_ms = static_cast<int>(1000 * late_s);
  std::cout << "The machine was " << late_ms << " ms late in try " << next << " of " << kTries
            << std::endl;
  const int least_ms = std::min(late_ms, number_in(kLate_ms, late_ms));
  if (next == kTries) {
    std::cout << "not measured: the machine was " << least_ms << " ms late in each of " << kTries
              << " tries" << std::endl;
    return result;
  }
  std::this_thread::sleep_for(next * kPause);
  ::setenv(kTry, std::to_string(next).c_str(), 1);
  ::setenv(kLate_ms, std::to_string(least_ms).c_str(), 1);
  ::execv(argv[0], again.data());
  return result;
}
