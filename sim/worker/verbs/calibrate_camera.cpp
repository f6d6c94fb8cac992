#include "sim/worker/verbs/calibrate_camera.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "sim/base/artifact_file.h"
#include "sim/calibrate/camera_file.h"
#include "sim/registration/camera/calibration_board.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/frames.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples =
    R"(Record twelve views of the calibration board (see sim/registration/README.md), each with 1 s of frames. Hold the board
still, fully in view, and at least 30 mm in front of the background. Tilt it by 30 degrees in each direction, hold it near
and far, and move it to the corners of the image.

Example:
  hydroprint-worker calibrate-camera --frames view1 view2 view3 view4 view5 view6 --out camera

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

constexpr std::size_t kFramesForSteps = 10;

using Views = std::vector<std::filesystem::path>;

void add_flags(Flags& flags) {
  flags.add_fields();
  add_frames_flag(flags);
}

/// Finds the camera's depth steps from all views, because a single view may not show them.
Result<std::optional<scan::DepthSteps>> depth_steps(const std::vector<std::filesystem::path>& views,
                                                    const Context& context) {
  scan::DepthCounts counts;
  for (const std::filesystem::path& view : views) {
    HP_ASSIGN_OR_RETURN(const auto taken, calibrate::read_frames(view, context, kFramesForSteps));
    counts.add(taken.frames);
  }
  return scan::find_depth_steps(counts);
}

void set_camera(const registration::CameraCalibration& camera, v1::CalibrateCameraReport& out) {
  out.set_width_px(camera.lens.width_px);
  out.set_height_px(camera.lens.height_px);
  add_all(camera.lens.parameters(), out.mutable_lens());
  add_rows(camera.covariance, out.mutable_covariance());
  out.set_views(static_cast<std::int32_t>(camera.views));
  out.set_rms_mm(camera.rms_mm);
  out.set_rms_sigmas(camera.rms_sigmas);
}

class CalibrateCamera final : public ReportTask<v1::CalibrateCameraReport> {
 public:
  explicit CalibrateCamera(Views views)
      : ReportTask("calibrate-camera"), views_(std::move(views)) {}

  [[nodiscard]] std::string subject() const override { return views_.front().string(); }
  [[nodiscard]] std::string memory_tip() const override { return "fewer frames"; }
  [[nodiscard]] std::vector<Stage> stages() const override {
    return {{"inputs", 1}, {"reading", 20}, {"boards", 60}, {"adjusting", 18}, {"writing", 1}};
  }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    std::vector<InputPath> out;
    append_frames(out, views_);
    return out;
  }

  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;

  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override;

 private:
  Views views_;
  registration::CameraCalibration camera_;
};

Status CalibrateCamera::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  HP_RETURN_IF_ERROR(check_cancelled(context));
  const scan::DepthNoise noise;
  HP_ASSIGN_OR_RETURN(const auto steps, depth_steps(views_, context));
  std::vector<scan::FusedFrame> fused_views;
  scan::Lens nominal;
  for (const std::filesystem::path& view : views_) {
    HP_ASSIGN_OR_RETURN(const calibrate::Frames frames, calibrate::read_frames(view, context));
    auto fused = scan::fuse(frames.frames, noise, steps, context);
    if (!fused) {
      fused.error().message.insert(0, view.string() + ": ");
      return tl::unexpected(std::move(fused).error());
    }
    fused_views.push_back(std::move(*fused));
    nominal = frames.nominal_lens;
  }
  HP_ASSIGN_OR_RETURN(camera_,
                      registration::calibrate_camera(fused_views, registration::calibration_board(),
                                                     nominal, noise, context));
  context.progress("writing", 0);
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(
      image::write_artifact(folder.partial() / "camera.json", calibrate::camera_json(camera_)));
  run.add_artifacts("camera.json");
  set_camera(camera_, report_);
  return {};
}

std::string CalibrateCamera::summary(const std::filesystem::path& dir) const {
  return fmt::format(
      "{}{} views; focal length {:.1f} px, depth scale {:+.2f} %; residual of the board {:.2f} mm "
      "(rms)\n",
      artifacts_line(dir, report_.run()), camera_.views, camera_.lens.fx_px,
      100 * (camera_.lens.depth_scale - 1), camera_.rms_mm);
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& inputs) {
  HP_ASSIGN_OR_RETURN(Views views,
                      frames_folders(static_cast<const v1::CalibrateCameraSpec&>(spec), inputs, 0));
  return std::make_unique<CalibrateCamera>(std::move(views));
}

}  // namespace

Verb calibrate_camera_verb() {
  return {"calibrate-camera",
          "Find a camera's lens and depth scale from views of the calibration board",
          kExamples,
          &v1::CalibrateCameraSpec::default_instance(),
          add_flags,
          plan};
}

}  // namespace hydroprint::worker
