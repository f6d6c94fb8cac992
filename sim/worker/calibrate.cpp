#include "sim/worker/calibrate.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "sim/calibrate/camera_file.h"
#include "sim/calibrate/frames_folder.h"
#include "sim/image/alignment_picture.h"
#include "sim/image/artifact_file.h"
#include "sim/image/image_file.h"
#include "sim/image/pictures.h"
#include "sim/mesh/make_surface.h"
#include "sim/mesh/read_model.h"
#include "sim/registration/calibration_board.h"
#include "sim/worker/calibrate_json.h"

namespace hydroprint::worker {
namespace {

constexpr std::size_t kFramesForSteps = 10;

/// The object coloured by registration error.
Result<image::RgbImage> error_picture(const mesh::Surface& surface, const Pose& X_FO,
                                      const std::vector<double>& error_mm, const Context& context) {
  std::vector<flow::MappedTriangle> whole(surface.triangles.size());
  for (std::size_t t = 0; t < whole.size(); ++t) {
    whole[t].triangle = static_cast<int>(t);
    whole[t].barycentric = {Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY(),
                            Eigen::Vector3f::UnitZ()};
  }
  const auto at_corners = [&](const flow::MappedTriangle& tile) {
    const Eigen::Vector3i& v = surface.triangles[static_cast<std::size_t>(tile.triangle)];
    return std::array{error_mm[static_cast<std::size_t>(v[0])],
                      error_mm[static_cast<std::size_t>(v[1])],
                      error_mm[static_cast<std::size_t>(v[2])]};
  };
  const image::Quantity error{"error, mm", error_mm, 0, 0.1, at_corners, {}};
  HP_ASSIGN_OR_RETURN(const auto views, image::find_views(surface, X_FO, whole, context));
  return image::quantity_picture(views, error, context);
}

Status write_pictures(const std::filesystem::path& folder, const mesh::Surface& surface,
                      const calibrate::Calibration& found, const Context& context) {
  context.progress("pictures", 0);
  const Pose& X_FO = found.object.X_FO;
  HP_ASSIGN_OR_RETURN(const auto views, image::find_views(surface, X_FO, {}, context));
  HP_ASSIGN_OR_RETURN(const auto alignment,
                      image::alignment_picture(views, found.points_O, found.off_mm, context));
  HP_RETURN_IF_ERROR(
      image::write_png(folder / "alignment.png", alignment, image::kScreenDpi, context));
  HP_ASSIGN_OR_RETURN(const auto error, error_picture(surface, X_FO, found.error_mm, context));
  return image::write_png(folder / "error.png", error, image::kScreenDpi, context);
}

/// z of the lowest point where the object hangs.
double lowest_mm(const mesh::Surface& surface, const Pose& X_FO) {
  double out = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : surface.points) out = std::min(out, (X_FO * p).z());
  return out;
}

/// Of the camera: no single view need tell them.
Result<std::optional<scan::DepthSteps>> depth_steps(const std::vector<std::filesystem::path>& views,
                                                    const Context& context) {
  scan::DepthCounts counts;
  for (const std::filesystem::path& view : views) {
    HP_ASSIGN_OR_RETURN(const auto taken, calibrate::read_frames(view, context, kFramesForSteps));
    counts.add(taken.frames);
  }
  return scan::find_depth_steps(counts);
}

}  // namespace

std::vector<Stage> calibrate_stages() {
  return {{"inputs", 1},  {"reading", 5},   {"fusing", 5},    {"normals", 5}, {"markers", 20},
          {"object", 15}, {"aligning", 30}, {"pictures", 15}, {"writing", 4}};
}

std::vector<Stage> calibrate_camera_stages() {
  return {{"inputs", 1}, {"reading", 20}, {"boards", 60}, {"adjusting", 18}, {"writing", 1}};
}

Result<calibrate::Frames> read_scan(const Options& options, registration::CameraCalibration& camera,
                                    const Context& context) {
  HP_ASSIGN_OR_RETURN(calibrate::Frames out,
                      calibrate::read_frames(options.frames.front(), context));
  if (options.camera.empty()) {
    camera = calibrate::uncalibrated(out.nominal_lens);
  } else {
    HP_ASSIGN_OR_RETURN(camera, calibrate::read_camera(options.camera));
  }
  return out;
}

Status run_calibrate(const Options& options, const pipeline::DipOptions& dip, OutFolder& folder,
                     Report& report, const Context& context) {
  context.progress("reading", 0);
  calibrate::Task task;
  HP_ASSIGN_OR_RETURN(task.layout, calibrate::read_layout(options.layout));
  HP_ASSIGN_OR_RETURN(const calibrate::Frames taken, read_scan(options, task.camera, context));
  HP_ASSIGN_OR_RETURN(const mesh::Model model,
                      mesh::read_model(options.mesh, options.scale, context));
  HP_ASSIGN_OR_RETURN(task.surface,
                      mesh::make_surface(model, std::numeric_limits<double>::infinity(), context));
  report.mesh_vertices = model.vertices.size();
  report.mesh_triangles = model.triangles.size();
  task.frames = taken.frames;
  task.nominal_FO = dip.X_FO;
  task.gripper_mm = options.gripper_mm;
  task.half_film_mm = (dip.outline.max_mm - dip.outline.min_mm) / 2;
  HP_ASSIGN_OR_RETURN(calibrate::Calibration found, calibrate::calibrate(task, context));
  report.X_FO = found.object.X_FO;
  report.lowest_mm = lowest_mm(task.surface, report.X_FO);
  report.warnings = model.warnings;
  report.warnings.insert(report.warnings.end(), found.warnings.begin(), found.warnings.end());
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(write_pictures(folder.partial(), task.surface, found, context));
  context.progress("writing", 0);
  HP_RETURN_IF_ERROR(
      image::write_artifact(folder.partial() / "calibration.json",
                            calibration_json(found, report.lowest_mm).dump(1) + "\n"));
  HP_RETURN_IF_ERROR(image::write_artifact(folder.partial() / "pose.json",
                                           pose_json(found.object.X_FO).dump(1) + "\n"));
  report.artifacts = {"calibration.json", "pose.json", "alignment.png", "error.png"};
  report.calibration = std::move(found);
  return {};
}

Status run_calibrate_camera(const Options& options, OutFolder& folder, Report& report,
                            const Context& context) {
  const scan::DepthNoise noise;
  HP_ASSIGN_OR_RETURN(const auto steps, depth_steps(options.frames, context));
  std::vector<scan::FusedFrame> views;
  scan::Lens nominal;
  for (const std::filesystem::path& view : options.frames) {
    HP_ASSIGN_OR_RETURN(const calibrate::Frames taken, calibrate::read_frames(view, context));
    auto fused = scan::fuse(taken.frames, noise, steps, context);
    if (!fused) {
      fused.error().message.insert(0, view.string() + ": ");
      return tl::unexpected(std::move(fused).error());
    }
    views.push_back(std::move(*fused));
    nominal = taken.nominal_lens;
  }
  HP_ASSIGN_OR_RETURN(report.camera,
                      registration::calibrate_camera(views, registration::calibration_board(),
                                                     nominal, noise, context));
  context.progress("writing", 0);
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(image::write_artifact(folder.partial() / "camera.json",
                                           calibrate::camera_json(*report.camera)));
  report.artifacts = {"camera.json"};
  return {};
}

}  // namespace hydroprint::worker
