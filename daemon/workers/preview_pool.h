#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/workers/preview_worker.h"

namespace hydroprint::daemon {

/// Settings for previews.
struct PreviewOptions {
  std::filesystem::path program;
  std::filesystem::path confine_program;  ///< hydroprint-confine
  int threads = 1;
  confine::Limits limits;
};

/// Reads models, and computes previews of dips while users rotate an object. Each user has a worker
/// that keeps the mesh in memory as long as requests arrive. A new call ends the user's previous
/// call.
class PreviewPool {
 public:
  [[nodiscard]] static Result<std::unique_ptr<PreviewPool>> make(PreviewOptions options,
                                                                 const Layout& layout);
  ~PreviewPool();
  PreviewPool(const PreviewPool&) = delete;
  PreviewPool& operator=(const PreviewPool&) = delete;

  /// Has a worker answer a request, and waits for the answer.
  /// @param gone  called repeatedly; returns whether the client has disconnected
  /// @return kAborted, PREVIEW_SUPERSEDED; kResourceExhausted, PREVIEWS_FULL, TIME_LIMIT or
  ///         MEMORY_LIMIT; kUnavailable, SHUTTING_DOWN; kCancelled; errors of the worker
  [[nodiscard]] Result<PreviewFrame> compute(const std::string& owner, const PreviewRequest& ask,
                                             const std::function<bool()>& gone);
  /// Ends all workers; waiting calls return an error.
  void stop();

 private:
  using SteadyTime = std::chrono::steady_clock::time_point;
  struct Call;
  struct Slot;

  PreviewPool(PreviewOptions options, Layout layout);
  [[nodiscard]] Result<std::shared_ptr<Call>> place(const std::string& owner,
                                                    const PreviewRequest& ask);
  [[nodiscard]] bool make_room();
  void work();
  void serve(Slot& slot, SteadyTime now);
  void begin(Slot& slot);
  void take(Slot& slot, PreviewFrame frame);
  void wait(std::unique_lock<std::mutex>& lock);
  void finish(Slot& slot, Result<PreviewFrame> result);

  PreviewOptions options_;
  Layout layout_;
  UniqueFd wake_;
  std::mutex mutex_;
  std::condition_variable answered_;
  std::map<std::string, std::unique_ptr<Slot>> slots_;  // keyed by owner
  std::int64_t last_id_ = 0;
  bool stopping_ = false;
  std::thread thread_;  // starts all workers, which are killed when the thread ends
};

}  // namespace hydroprint::daemon
