#include "sim/worker/verbs/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/warning_message.h"
#include "sim/calibrate/calibrate.h"
#include "sim/film/outline.h"
#include "sim/image/figures/alignment_picture.h"
#include "sim/image/figures/pictures.h"
#include "sim/image/io/image_file.h"
#include "sim/mesh/make_surface.h"
#include "sim/mesh/read/read_model.h"
#include "sim/mesh/weld.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/frames.h"
#include "sim/worker/common/object.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples =
    R"(calibration.json: the object's pose in the film frame with its covariance, the directions taken from the nominal
pose because the scan does not determine them, the turns that carry the mesh onto itself, the fit of each marker, and
the water level. pose.json: the pose and its error, for --pose of simulate and print-image. alignment.png: the scan's
points over the mesh, coloured by distance. error.png: the uncertainty of the surface's position.

Examples:
  hydroprint-capture --seconds 2 --out frames
  hydroprint-worker calibrate --frames frames --layout rig_layout.toml --camera camera.json --mesh mug.obj --scale 10 --out held
  hydroprint-worker simulate --mesh mug.obj --scale 10 --pose held/pose.json --out film

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

struct CalibrateOptions {
  ObjectOptions object;  ///< its pose is the nominal one
  std::filesystem::path frames;
  std::filesystem::path layout;
  std::filesystem::path camera;      ///< empty: the driver's lens
  std::optional<double> gripper_mm;  ///< height of its lower end above z = 0; nullopt: not in view
};

void add_flags(Flags& flags) {
  flags.add_fields();
  add_frames_flag(flags);
  flags.require("layout");
}

Result<CalibrateOptions> read_options(const v1::CalibrateSpec& spec, const InputFolder& inputs) {
  CalibrateOptions out;
  HP_ASSIGN_OR_RETURN(out.object, object_options(spec, inputs));
  HP_ASSIGN_OR_RETURN(const auto folders, frames_folders(spec, inputs, 1));
  out.frames = folders.front();
  HP_ASSIGN_OR_RETURN(out.layout, inputs.required("layout", spec.layout()));
  out.camera = inputs.path(spec.camera());
  if (spec.has_gripper_mm()) out.gripper_mm = spec.gripper_mm();
  return out;
}

/// Returns a picture of the object, coloured by the uncertainty of the surface's position.
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

/// Returns z of the lowest point of the object at the given pose.
double lowest_mm(const mesh::Surface& surface, const Pose& X_FO) {
  double out = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : surface.points) out = std::min(out, (X_FO * p).z());
  return out;
}

void set_uncertainty(const calibrate::Calibration& found, v1::CalibrationFacts& out) {
  v1::CalibrationFacts::Uncertainty& uncertainty = *out.mutable_uncertainty();
  add_all(found.object.centre_mm, uncertainty.mutable_about_mm());
  add_rows(found.object.covariance, uncertainty.mutable_covariance_turn_rad_shift_mm());
  uncertainty.set_error_p50_mm(calibrate::error_quantile_mm(found.error_mm, 0.5));
  uncertainty.set_error_p95_mm(found.uncertainty.error_p95_mm.value_or(0));
  uncertainty.set_error_max_mm(calibrate::error_quantile_mm(found.error_mm, 1));
  add_all(found.uncertainty.from_nominal_pose, out.mutable_from_nominal_pose());
  if (!found.object.symmetry.empty()) out.add_symmetries(found.object.symmetry);
}

void set_scan(const registration::ObjectPose& object, v1::CalibrationFacts::Scan& out) {
  out.set_points(static_cast<std::int32_t>(object.fit.points));
  out.set_on_object_share(object.on_share);
  out.set_misfit_mm(object.misfit_mm);
  out.set_rms_mm(object.fit.rms_mm);
  out.set_rms_sigmas(object.fit.rms_sigmas);
  out.set_out_of_view_share(object.sight.out_of_view);
  out.set_hidden_share(object.sight.before + object.sight.without_depth);
}

/// @param lowest_mm  z of the object's lowest point (F)
void set_calibration(const calibrate::Calibration& found, double lowest_mm,
                     v1::CalibrationFacts& out) {
  set_pose(found.object.X_FO, *out.mutable_pose());
  set_uncertainty(found, out);
  set_film_frame(found.film_frame, *out.mutable_film_frame());
  set_scan(found.object, *out.mutable_scan());
  if (found.water) {
    out.mutable_water()->set_z_mm(found.water->z_mm);
    out.mutable_water()->set_sigma_mm(found.water->sigma_mm);
  }
  out.set_height_mm(lowest_mm - (found.water ? found.water->z_mm : 0));
}

class Calibrate final : public ReportTask<v1::CalibrateReport> {
 public:
  explicit Calibrate(CalibrateOptions options)
      : ReportTask("calibrate"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override { return options_.frames.string(); }
  [[nodiscard]] std::string memory_tip() const override { return "fewer frames, a smaller model"; }
  [[nodiscard]] std::vector<Stage> stages() const override {
    return {{"inputs", 1},  {"reading", 5},   {"fusing", 5},    {"normals", 5}, {"markers", 20},
            {"object", 15}, {"aligning", 30}, {"pictures", 15}, {"writing", 4}};
  }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    std::vector<InputPath> out = {{"mesh", options_.object.mesh},
                                  {"pose", options_.object.pose_file},
                                  film_file(options_.object.film),
                                  {"layout", options_.layout},
                                  {"camera", options_.camera}};
    append_frames(out, {options_.frames});
    return out;
  }

  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;

  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override;

 private:
  [[nodiscard]] Status write(const std::filesystem::path& folder, const Context& context);

  CalibrateOptions options_;
  calibrate::Calibration found_;
};

Status Calibrate::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  const ObjectOptions& object = options_.object;
  HP_ASSIGN_OR_RETURN(const film::Outline outline, film::parse_outline(object.film));
  HP_RETURN_IF_ERROR(check_cancelled(context));
  context.progress("reading", 0);
  calibrate::Task task;
  HP_ASSIGN_OR_RETURN(task.layout, calibrate::read_layout(options_.layout));
  HP_ASSIGN_OR_RETURN(const Scan scan, read_scan(options_.frames, options_.camera, context));
  HP_ASSIGN_OR_RETURN(const mesh::Model model,
                      mesh::read_model(object.mesh, object.scale, context));
  HP_ASSIGN_OR_RETURN(task.surface,
                      mesh::make_surface(model, std::numeric_limits<double>::infinity(), context));
  // The alignment computes in floats, so the surface is moved to the origin, and the poses with it.
  const Eigen::Vector3d centre_mm = mesh::far_centre_mm(model.vertices);
  for (Eigen::Vector3d& p : task.surface.points) p -= centre_mm;
  task.frames = scan.frames.frames;
  task.camera = scan.camera;
  task.nominal_FO = object.X_FO;
  if (task.nominal_FO) task.nominal_FO->translate(centre_mm);
  task.gripper_mm = options_.gripper_mm;
  task.half_film_mm = outline.size_mm() / 2;
  HP_ASSIGN_OR_RETURN(found_, calibrate::calibrate(task, context));
  const double lowest = lowest_mm(task.surface, found_.object.X_FO);
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(write_pictures(folder.partial(), task.surface, found_, context));
  found_.object.X_FO.translate(-centre_mm);
  report_.set_scale(object.scale);
  set_film(outline, *report_.mutable_film());
  if (options_.gripper_mm) report_.set_gripper_mm(*options_.gripper_mm);
  set_mesh(model, *report_.mutable_mesh());
  set_calibration(found_, lowest, *report_.mutable_calibration());
  add_warnings(model.warnings, *run.mutable_warnings());
  add_warnings(found_.warnings, *run.mutable_warnings());
  HP_RETURN_IF_ERROR(write(folder.partial(), context));
  for (const char* name : {"calibration.json", "pose.json", "alignment.png", "error.png"})
    run.add_artifacts(name);
  return {};
}

Status Calibrate::write(const std::filesystem::path& folder, const Context& context) {
  context.progress("writing", 0);
  v1::Pose pose = report_.calibration().pose();
  hydroprint::set_uncertainty(found_.uncertainty, pose);
  HP_RETURN_IF_ERROR(write_message(folder / "calibration.json", *report_.mutable_calibration()));
  return write_message(folder / "pose.json", pose);
}

std::string Calibrate::summary(const std::filesystem::path& dir) const {
  const auto& markers = found_.film_frame.markers;
  const auto used =
      std::count_if(markers.begin(), markers.end(), [](const auto& m) { return m.used; });
  std::string weak;
  for (const std::string& what : found_.uncertainty.from_nominal_pose)
    weak += "taken from the nominal pose: " + what + "\n";
  if (!found_.object.symmetry.empty())
    weak += "does not move the surface, so it is not measured: " + found_.object.symmetry + "\n";
  return fmt::format(
      "{}used {} of {} markers; residual of the object's fit {:.2f} mm (rms), uncertainty of the "
      "surface {:.2f} mm (95th percentile)\n{}",
      artifacts_line(dir, report_.run()), used, markers.size(), found_.object.fit.rms_mm,
      found_.uncertainty.error_p95_mm.value_or(0), weak);
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& inputs) {
  HP_ASSIGN_OR_RETURN(CalibrateOptions options,
                      read_options(static_cast<const v1::CalibrateSpec&>(spec), inputs));
  return std::make_unique<Calibrate>(std::move(options));
}

}  // namespace

Verb calibrate_verb() {
  return {
      "calibrate", "Find the object's pose over the film, with its uncertainty, from depth frames",
      kExamples,   &v1::CalibrateSpec::default_instance(),
      add_flags,   plan};
}

}  // namespace hydroprint::worker
