#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "hardware/simulator/camera/renderer.h"
#include "hardware/simulator/openni_driver/oni_driver.h"
#include "hardware/simulator/openni_driver/rig_line.h"

namespace hydroprint::openni_driver {

/// Frames of the rig's camera, rendered at the frame rate by a separate thread.
class DepthStream : public oni::driver::StreamBase {
 public:
  /// @param on_gone  called from the stream's thread when the camera disappears; the thread then
  ///                 ends
  DepthStream(const simulated_scene::Scenery& scenery, simulated_camera::Renderer& renderer,
              std::string control, std::function<void()> on_gone);
  ~DepthStream() override;

  OniStatus getProperty(int id, void* data, int* size) override;
  OniStatus setProperty(int id, const void* data, int size) override;
  OniBool isPropertySupported(int id) override;
  OniStatus start() override;
  void stop() override;

  [[nodiscard]] static OniVideoMode mode();

 private:
  void run(RigLine line);
  [[nodiscard]] bool wait_until(std::chrono::steady_clock::time_point time);
  /// Returns false once the camera has disappeared.
  [[nodiscard]] bool tell_frame(RigLine& line, int index);
  void publish(int index, double time_s);

  simulated_camera::Renderer& renderer_;
  const bool counts_frames_;
  const std::string control_;
  const std::function<void()> on_gone_;
  simulated_camera::Frame last_;
  std::mutex mutex_;
  std::condition_variable wakes_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace hydroprint::openni_driver
