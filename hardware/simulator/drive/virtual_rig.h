#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hardware/drive/transaction.h"
#include "hardware/simulator/drive/camera_control.h"
#include "hardware/simulator/drive/faults.h"
#include "hardware/simulator/drive/plant.h"
#include "hardware/simulator/drive/scene.h"
#include "hardware/simulator/drive/serial_server.h"
#include "hardware/simulator/drive/socket_server.h"
#include "sim/base/process/periodic_thread.h"

namespace hydroprint::simulated_drive {

/// Options of a virtual rig.
struct Options {
  drive::DriveProfile profile;  ///< profile of the simulated drive
  Scene scene;
  std::optional<int> tcp_port;          ///< 0: any free port; nullopt: no TCP
  std::optional<drive::Endpoint> line;  ///< nullopt: no RTU
  std::filesystem::path control;        ///< path of the control socket; empty: none
  /// nullopt: the largest value that the profile permits
  std::optional<double> watchdog_s;
  std::optional<std::uint16_t> watchdog_action;  ///< nullopt: the first action that stops the axis
  std::vector<TimedAction> actions;
};

/// Returns the machine that results from a profile and a scene.
[[nodiscard]] Machine machine_of(const drive::DriveProfile& profile, const Scene& scene);

/// A simulated drive with its connections: a plant, its servers, and a clock. Thread-safe.
class VirtualRig {
 public:
  /// Returns an error if an address is in use, or if the object cannot be loaded for the camera.
  [[nodiscard]] static Result<std::unique_ptr<VirtualRig>> start(const Options& options);
  ~VirtualRig();
  VirtualRig(const VirtualRig&) = delete;
  VirtualRig& operator=(const VirtualRig&) = delete;

  /// Performs an action and returns the response for the control socket: "ok", the requested data
  /// as JSON, or the help.
  [[nodiscard]] Result<std::string> perform(const Action& action);

  /// Returns the response to a line of the control socket: that of perform(), or "error: ...".
  [[nodiscard]] std::string reply_to(const std::string& line);

  /// Returns the drive's TCP port; 0 if TCP is off.
  [[nodiscard]] int tcp_port() const { return tcp_port_; }

 private:
  explicit VirtualRig(const Options& options);
  [[nodiscard]] Status plug();
  void unplug();
  void boot();
  void serve_control(int descriptor);
  void tick(std::chrono::steady_clock::time_point start);

  Options options_;
  Plant plant_;
  int tcp_port_ = 0;  // set before any thread starts, then constant
  CameraControl camera_control_;
  std::mutex plugs_;  // protects tcp_, serial_ and boots_at_
  std::unique_ptr<SocketServer> tcp_;
  std::unique_ptr<SerialServer> serial_;
  std::optional<std::chrono::steady_clock::time_point> boots_at_;
  std::optional<PeriodicThread> clock_;
  std::unique_ptr<SocketServer> control_;
};

}  // namespace hydroprint::simulated_drive
