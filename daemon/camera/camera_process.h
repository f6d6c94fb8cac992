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

namespace hydroprint::daemon {

/// A process `hydroprint-capture --live`, which occupies the camera while it runs. Use it only on
/// the thread that started it; only the destructor blocks.
class CameraProcess {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// @return kInternal, WORKER_UNUSABLE
  [[nodiscard]] static Result<std::unique_ptr<CameraProcess>> start(const CameraConfig& camera,
                                                                    const Layout& layout);
  /// Kills the process and waits at most 2 s, because it may hang in the kernel.
  ~CameraProcess();
  CameraProcess(const CameraProcess&) = delete;
  CameraProcess& operator=(const CameraProcess&) = delete;

  /// Returns descriptors that become readable when read() or has_ended() should be called; negative
  /// ones never become readable.
  [[nodiscard]] std::vector<int> descriptors() const;
  /// Returns the pictures received since the last call.
  [[nodiscard]] std::vector<FramedMessage> read(Time now);
  /// Asks the process to end; it is killed after 2 s.
  void ask_to_end(Time now);
  /// Returns whether the process has ended and released the camera. Kills it if it was silent for
  /// too long.
  [[nodiscard]] bool has_ended(Time now);
  /// Returns why the process ended; nullopt if it is running or was asked to end.
  [[nodiscard]] std::optional<Error> failure() const;

 private:
  CameraProcess(std::filesystem::path folder, std::chrono::seconds patience);

  std::filesystem::path folder_;
  std::chrono::seconds patience_;  ///< maximum time without output
  ChildProcess process_;
  Time last_output_;
  std::optional<Time> kill_at_;  ///< set if the process was asked to end
  bool timed_out_ = false;       ///< the process was killed because it sent nothing for too long
  bool is_readable_ = true;      ///< its pipe is open, and all messages were well-formed
  std::string buffer_;           ///< received bytes of an incomplete picture
  std::string words_;
  std::optional<int> wait_status_;
};

}  // namespace hydroprint::daemon
