#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace hydroprint::worker {

/// How this process ends, decided once: by the main thread, with a result or an error, or by a
/// signal that came first.
///
/// SIGINT, SIGTERM and SIGHUP ask for the end: `requested()` turns true, which the computation
/// sees and unwinds. A stage that does not look for it in time (a file in the hands of an importer)
/// is not waited for: after a grace period, or at a second signal, `last_words` runs and the
/// process exits with status 130.
///
/// Must be made before any other thread, which inherit its signal mask.
class Termination {
 public:
  explicit Termination(std::function<void()> last_words);
  /// Stops listening.
  ~Termination();
  Termination(const Termination&) = delete;
  Termination& operator=(const Termination&) = delete;

  [[nodiscard]] bool requested() const { return requested_; }
  /// Asks for the end as a signal does; from any thread.
  void request() { requested_ = true; }
  /// The main thread alone decides from here on how the process ends. Does not return if the
  /// signal thread has decided already.
  void decide();
  /// What last_words has to clean up; empty: nothing. Returns after a running clean-up has ended.
  void set_cleanup(std::function<void()> cleanup);

 private:
  void listen();

  std::function<void()> last_words_;
  std::function<void()> cleanup_;
  std::mutex mutex_;
  std::atomic<bool> requested_ = false;
  enum class By { kNobody, kMain, kSignal };
  std::atomic<By> decided_ = By::kNobody;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

/// Has something cleaned up if a signal ends the process while this lives.
class CleanupAtTermination {
 public:
  CleanupAtTermination(Termination& termination, std::function<void()> cleanup)
      : termination_(termination) {
    termination_.set_cleanup(std::move(cleanup));
  }
  ~CleanupAtTermination() { termination_.set_cleanup({}); }
  CleanupAtTermination(const CleanupAtTermination&) = delete;
  CleanupAtTermination& operator=(const CleanupAtTermination&) = delete;

 private:
  Termination& termination_;
};

}  // namespace hydroprint::worker
