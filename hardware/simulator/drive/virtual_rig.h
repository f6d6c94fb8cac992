#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hardware/drive/transaction.h"
#include "hardware/simulator/drive/camera_control.h"
#include "hardware/simulator/drive/faults.h"
#include "hardware/simulator/drive/plant.h"
#include "hardware/simulator/drive/scene.h"
#include "hardware/simulator/drive/serial_server.h"
#include "hardware/simulator/drive/socket_server.h"

namespace hydroprint::simulated_drive {

/// What a virtual rig is made of.
struct Options {
  drive::DriveProfile profile;  ///< of the drive that is played
  Scene scene;
  std::optional<int> tcp_port;                   ///< 0: any free one; none: no TCP
  std::optional<drive::Endpoint> line;           ///< none: no RTU
  std::filesystem::path control;                 ///< where actions are taken; empty: nowhere
  std::optional<double> watchdog_s;              ///< none: the largest that the profile accepts
  std::optional<std::uint16_t> watchdog_action;  ///< none: the first that stops
  std::vector<TimedAction> actions;
};

/// The machine that a profile and a scene make.
[[nodiscard]] Machine machine_of(const drive::DriveProfile& profile, const Scene& scene);

/// A drive on its wires: a plant, what serves it, and a clock that moves it. Any thread may call.
class VirtualRig {
 public:
  /// Refuses what cannot be listened at, and an object that the camera cannot see.
  [[nodiscard]] static Result<std::unique_ptr<VirtualRig>> start(const Options& options);
  ~VirtualRig();
  VirtualRig(const VirtualRig&) = delete;
  VirtualRig& operator=(const VirtualRig&) = delete;

  /// Does it, and says what a control line gets back: "ok", the state as JSON, or help.
  [[nodiscard]] Result<std::string> perform(const Action& action);

  /// The reply to a line of the control socket: perform()'s, or "error: ...".
  [[nodiscard]] std::string reply_to(const std::string& line);

  /// Where the drive is on TCP; port 0 if it is not.
  [[nodiscard]] int tcp_port() const { return tcp_port_; }

 private:
  explicit VirtualRig(const Options& options);
  [[nodiscard]] Status plug();
  void unplug();
  void boot();
  void serve_control(int descriptor);
  void run_clock();

  Options options_;
  Plant plant_;
  int tcp_port_ = 0;  // found before any thread of its own begins, and kept
  CameraControl camera_control_;
  std::mutex plugs_;  // of what follows
  std::unique_ptr<SocketServer> tcp_;
  std::unique_ptr<SerialServer> serial_;
  std::optional<std::chrono::steady_clock::time_point> boots_at_;
  std::atomic<bool> ends_ = false;
  std::thread clock_;
  std::unique_ptr<SocketServer> control_;
};

}  // namespace hydroprint::simulated_drive
