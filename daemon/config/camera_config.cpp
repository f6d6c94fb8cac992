#include "daemon/config/camera_config.h"

#include "sim/base/input_file.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kLargestLayout = 1 << 20;

}  // namespace

Status check_camera(const CameraConfig& setup) {
  if (!setup.device.empty()) return {};
  return fail(Code::kFailedPrecondition,
              "no camera is configured; set camera.device in the daemon's configuration, or enter "
              "a calibration by hand",
              ErrorReason::CAMERA_MISSING);
}

Result<std::string> read_layout_text(const CameraConfig& setup) {
  auto text = read_text_file(setup.layout, kLargestLayout);
  if (text) return text;
  return fail(Code::kInvalidArgument, "camera.layout: " + text.error().message,
              ErrorReason::CONFIG_INVALID);
}

Result<CameraConfig> read_camera_setup(const Config& config) {
  CameraConfig out;
  out.device = config.camera_device;
  out.program = config.camera_program;
  out.patience_s = static_cast<int>(config.camera_patience_s);
  out.layout = config.camera_layout;
  if (config.camera_gripper_water_mm > 0) out.gripper_water_mm = config.camera_gripper_water_mm;
  if (!out.layout.empty()) HP_RETURN_IF_ERROR(read_layout_text(out));
  return out;
}

}  // namespace hydroprint::daemon
