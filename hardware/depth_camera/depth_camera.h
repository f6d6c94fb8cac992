#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "hardware/depth_camera/depth_frame.h"
#include "sim/base/result.h"

namespace hydroprint::depth_camera {

/// Description of a camera or recording.
struct SourceInfo {
  std::string uri;     ///< for a recording, its path
  std::string name;    ///< maker and model
  std::string serial;  ///< empty: none (recordings store none)
  int width = 0, height = 0;
  std::optional<int> frames;  ///< number of frames; only for a recording
};

/// A depth camera, or a recording, through OpenNI2. A driver may hang or crash: use each camera in
/// its own process (hydroprint-capture). Error reasons:
///   CAMERA_NOT_FOUND   the camera does not exist
///   CAMERA_UNUSABLE    the camera lacks a required feature, or OpenNI2 does not start
///   CAMERA_GONE        the camera was unplugged
///   CAMERA_STALLED     no frame arrived in time
///   RECORDING_INVALID  the file is not a recording, or is truncated
class DepthCamera {
 public:
  /// Opens a camera and starts its depth stream: 640 x 480, 30 Hz, whole mm, not mirrored.
  /// @param uri  name of the camera in OpenNI2 ("hydroprint:/run/rig" is the virtual rig's camera);
  ///             empty: the first connected camera
  [[nodiscard]] static Result<std::unique_ptr<DepthCamera>> open_device(const std::string& uri);

  /// Opens a recording (.oni). next() then returns every frame, as fast as frames can be read.
  [[nodiscard]] static Result<std::unique_ptr<DepthCamera>> open_recording(
      const std::filesystem::path& path);

  virtual ~DepthCamera() = default;
  DepthCamera(const DepthCamera&) = delete;
  DepthCamera& operator=(const DepthCamera&) = delete;

  [[nodiscard]] virtual const SourceInfo& info() const = 0;

  /// Returns the next frame; a camera returns one captured after the call. Returns nullopt at the
  /// end of a recording. Waits at most `timeout`.
  [[nodiscard]] virtual Result<std::optional<DepthFrame>> next(
      std::chrono::milliseconds timeout) = 0;

  /// Starts a lossless recording of all later frames, until finish_recording() or destruction.
  /// Returns kPermissionDenied if the file cannot be written.
  [[nodiscard]] virtual Status record(const std::filesystem::path& path) = 0;
  /// Ends the recording and stops the stream: next() returns no further frames.
  virtual void finish_recording() = 0;

 protected:
  DepthCamera() = default;
};

}  // namespace hydroprint::depth_camera
