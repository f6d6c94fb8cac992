#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/state_layout.h"
#include "daemon/workers/child_process.h"
#include "daemon/workers/message_framing.h"
#include "daemon/workers/preview_request.h"

namespace hydroprint::daemon {

/// One response of `hydroprint-worker preview`.
using PreviewFrame = FramedMessage;

/// A confined worker that keeps a mesh in memory and responds to requests. Use it only on the
/// thread that started it.
class PreviewWorker {
 public:
  /// @param number  number in the name of the worker's folder, which the destructor deletes
  /// @return kFailedPrecondition, ASSET_MISSING; kInternal, WORKER_UNUSABLE
  [[nodiscard]] static Result<std::unique_ptr<PreviewWorker>> start(
      const PreviewRequest& ask, std::int64_t number, const std::filesystem::path& program,
      const std::filesystem::path& confine_program, const confine::Limits& limits, int threads,
      const Layout& layout);
  ~PreviewWorker();
  PreviewWorker(const PreviewWorker&) = delete;
  PreviewWorker& operator=(const PreviewWorker&) = delete;

  /// Returns the key of the requests that this worker can answer; see PreviewRequest::key.
  [[nodiscard]] const std::string& key() const { return key_; }
  [[nodiscard]] int answers_fd() const { return worker_.answer.get(); }

  /// Sends a request. A failure means that the worker has ended; see failure().
  void ask(std::int64_t id, const std::string& dip);
  /// Returns the responses received since the last call.
  [[nodiscard]] std::vector<PreviewFrame> read();
  /// Returns why the worker ended, if it has; also set after a malformed response.
  [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

 private:
  PreviewWorker(std::string key, std::filesystem::path folder);
  void judge_end();

  std::string key_;
  std::filesystem::path folder_;
  ChildProcess worker_;
  std::string bytes_;  // received bytes of an incomplete message
  std::string words_;
  std::optional<Error> failure_;
};

}  // namespace hydroprint::daemon
