#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace hydroprint::worker {

/// Decides exactly once how this process ends: either the main thread ends it with a result or an
/// error, or a signal ends it first.
/// SIGINT, SIGTERM and SIGHUP request termination: `requested()` becomes true, and the computation
/// checks it and returns. A stage that does not check in time (such as an importer that reads a
/// file) is not waited for. After a grace period, or at a second signal, `last_words` runs and the
/// process exits with status 130.
/// Must be created before any other thread, because threads inherit its signal mask.
class Termination {
 public:
  explicit Termination(std::function<void()> last_words);
  /// Stops handling signals.
  ~Termination();
  Termination(const Termination&) = delete;
  Termination& operator=(const Termination&) = delete;

  [[nodiscard]] bool requested() const { return requested_; }
  /// Requests termination, as a signal does. May be called from any thread.
  void request() { requested_ = true; }
  /// Reserves the decision for the main thread: later signals have no effect. Does not return if
  /// the signal thread has already decided.
  void decide();
  /// Sets the clean-up function that runs before `last_words`; empty: none. Waits for a clean-up in
  /// progress.
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

/// Registers a clean-up function for its lifetime, in case a signal ends the process.
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
