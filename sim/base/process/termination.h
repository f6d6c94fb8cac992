#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace hydroprint::worker {

/// Decides once how this process ends: by the main thread with a result or an error, or by an
/// earlier signal.
///
/// SIGINT, SIGTERM and SIGHUP ask the process to end: `requested()` becomes true, and the
/// computation sees this and unwinds. A stage that does not check it in time (an importer at work
/// on a file) is not waited for. After a grace period, or at a second signal, `last_words` runs and
/// the process exits with status 130.
///
/// Must be created before any other thread, because threads inherit its signal mask.
class Termination {
 public:
  explicit Termination(std::function<void()> last_words);
  /// Stops listening.
  ~Termination();
  Termination(const Termination&) = delete;
  Termination& operator=(const Termination&) = delete;

  [[nodiscard]] bool requested() const { return requested_; }
  /// Asks the process to end, as a signal does; may be called from any thread.
  void request() { requested_ = true; }
  /// Leaves it to the main thread alone to decide how the process ends. Does not return if the
  /// signal thread has already decided.
  void decide();
  /// Sets the clean-up that runs before `last_words`; empty: nothing. Waits for a clean-up in
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

/// Runs a clean-up if a signal ends the process during this object's lifetime.
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
