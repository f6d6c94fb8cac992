#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "hardware/depth_camera/depth_frame.h"
#include "sim/base/result.h"

namespace hydroprint::depth_camera {

/// What a source of frames says of itself.
struct SourceInfo {
  std::string uri;     ///< of a recording: its path
  std::string name;    ///< maker and model
  std::string serial;  ///< empty: it has none (recordings keep none)
  int width = 0, height = 0;
  std::optional<int> frames;  ///< of a recording
};

/// A depth camera, or a recording of one, through OpenNI2. A driver may hang or crash: use it in a
/// process of its own (hydroprint-capture), one camera in each. Its reasons for errors:
///   CAMERA_NOT_FOUND   there is no such camera
///   CAMERA_UNUSABLE    it cannot do what is needed
///   CAMERA_GONE        it was unplugged
///   CAMERA_STALLED     no frame came in time
///   RECORDING_INVALID  the file is no recording, or is cut short
class DepthCamera {
 public:
  /// Opens a camera and starts its depth stream: 640 x 480, 30 Hz, whole mm, not mirrored.
  /// @param uri  as OpenNI2 has them ("hydroprint:/run/rig" is the virtual rig's); empty: the first
  ///             one that is plugged in
  [[nodiscard]] static Result<std::unique_ptr<DepthCamera>> open_device(const std::string& uri);

  /// Opens a recording (.oni); its frames come as fast as they are asked for, none left out.
  [[nodiscard]] static Result<std::unique_ptr<DepthCamera>> open_recording(
      const std::filesystem::path& path);

  virtual ~DepthCamera() = default;
  DepthCamera(const DepthCamera&) = delete;
  DepthCamera& operator=(const DepthCamera&) = delete;

  [[nodiscard]] virtual const SourceInfo& info() const = 0;

  /// The next frame; of a camera, one that comes from now on. None: the recording has ended.
  /// Waits no longer than `timeout`.
  [[nodiscard]] virtual Result<std::optional<DepthFrame>> next(
      std::chrono::milliseconds timeout) = 0;

  /// Records all frames of the stream from here on, without loss, until finish_recording() or the
  /// end of this. Refuses (kPermissionDenied) where no file can be written.
  [[nodiscard]] virtual Status record(const std::filesystem::path& path) = 0;
  /// No frame comes after it.
  virtual void finish_recording() = 0;

 protected:
  DepthCamera() = default;
};

}  // namespace hydroprint::depth_camera
