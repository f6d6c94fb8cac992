#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/camera_config.h"
#include "daemon/store/state_layout.h"
#include "daemon/workers/child_process.h"
#include "daemon/workers/message_framing.h"
#include "daemon/workers/sandbox.h"

namespace hydroprint::daemon {

/// `hydroprint-capture --live`: one process, which has the camera for as long as it lives. Belongs
/// to the thread that started it; no call waits, but for its end.
class CameraProcess {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// @return kInternal, WORKER_UNUSABLE
  [[nodiscard]] static Result<std::unique_ptr<CameraProcess>> start(const CameraConfig& camera,
                                                                    const Sandbox& sandbox,
                                                                    const Layout& layout);
  /// Kills it; waits 2 s at most, for one that hangs in the kernel ends when the kernel lets it.
  ~CameraProcess();
  CameraProcess(const CameraProcess&) = delete;
  CameraProcess& operator=(const CameraProcess&) = delete;

  /// What becomes readable when read() or has_ended() have something to say; below 0: nothing will.
  [[nodiscard]] std::vector<int> descriptors() const;
  /// The pictures that came by now.
  [[nodiscard]] std::vector<FramedMessage> read(Time now);
  /// Asks it to end; it is killed if it has not ended 2 s later.
  void ask_to_end(Time now);
  /// Whether it is gone, and the camera with it free. Kills what said nothing for too long.
  [[nodiscard]] bool has_ended(Time now);
  /// Why it ended, if nobody asked it to.
  [[nodiscard]] std::optional<Error> failure() const;

 private:
  CameraProcess(std::filesystem::path folder, std::chrono::seconds patience);

  std::filesystem::path folder_;
  std::chrono::seconds patience_;  ///< with its silence
  ChildProcess process_;
  Time heard_;
  std::optional<Time> kill_at_;  ///< it was asked to end
  bool silent_ = false;          ///< and killed for it
  bool talks_ = true;            ///< its pipe is open, and what came through it made sense
  std::string said_;             ///< and is no whole picture yet
  std::string words_;
  std::optional<int> wait_status_;
};

}  // namespace hydroprint::daemon
