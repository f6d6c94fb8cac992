#include "sim/worker/verbs/fuse.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/warning_message.h"
#include "sim/base/artifact_file.h"
#include "sim/calibrate/swept_scan.h"
#include "sim/image/figures/alignment_picture.h"
#include "sim/image/io/image_file.h"
#include "sim/mesh/make_surface.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/frames.h"
#include "sim/worker/common/report_values.h"
#include "sim/worker/common/surface_ply.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples =
    R"(scan.ply: the surface that a camera saw while it was swept by hand, from a volume of signed distances, in mm. With
--layout the surface is in the film frame and is cut off outside the rig's bars; otherwise it is in the camera's frame at
the first depth frame. camera_path.csv: the camera's path. Begin with the markers in view, keep 0.6 to 1.2 m away, and
sweep for 10 s.

Examples:
  hydroprint-capture --seconds 10 --record sweep.oni --out sweep
  hydroprint-worker fuse --frames sweep --layout rig_layout.toml --camera camera.json --out fused

Exit status: 0 done, 2 bad usage, 3 bad input (also if tracking of the camera failed), 4 the computation failed, 130
cancelled.)";

struct FuseOptions {
  std::filesystem::path frames;
  std::filesystem::path layout;  ///< empty: no markers are used
  std::filesystem::path camera;  ///< empty: the driver's lens
  double voxel_mm = 3;
};

void add_flags(Flags& flags) {
  flags.add_fields();
  add_frames_flag(flags);
}

Result<FuseOptions> read_options(const v1::FuseSpec& spec, const InputFolder& inputs) {
  FuseOptions out;
  HP_ASSIGN_OR_RETURN(const auto folders, frames_folders(spec, inputs, 1));
  out.frames = folders.front();
  out.layout = inputs.path(spec.layout());
  out.camera = inputs.path(spec.camera());
  if (spec.has_voxel_mm()) out.voxel_mm = spec.voxel_mm();
  return out;
}

/// Returns the camera's path, one line for each registered frame: its time, and the camera's pose
/// in the coordinate frame of the mesh.
std::string path_csv(const scan::Path& path, const std::vector<double>& times_s) {
  std::string out = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n";
  for (std::size_t i = 0; i < path.X_WC.size(); ++i) {
    if (!path.is_placed[i]) continue;
    const Eigen::Quaterniond q(path.X_WC[i].linear());
    const Eigen::Vector3d p = path.X_WC[i].translation();
    out += fmt::format("{:.6f},{:.4f},{:.4f},{:.4f},{:.8f},{:.8f},{:.8f},{:.8f}\n",
                       times_s[i] - times_s[0], p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
  }
  return out;
}

Status write_picture(const std::filesystem::path& path, const scan::TriangleMesh& mesh,
                     const Context& context) {
  context.progress("pictures", 0);
  mesh::Model model;
  model.path = path;
  model.vertices = mesh.points_mm;
  model.triangles = mesh.triangles;
  HP_ASSIGN_OR_RETURN(const mesh::Surface surface,
                      mesh::make_surface(model, std::numeric_limits<double>::infinity(), context));
  HP_ASSIGN_OR_RETURN(const auto views, image::find_views(surface, Pose::Identity(), {}, context));
  HP_ASSIGN_OR_RETURN(const auto picture, image::alignment_picture(views, {}, {}, context));
  return image::write_png(path, picture, image::kScreenDpi, context);
}

double length_mm(const scan::Path& path) {
  double out = 0;
  for (std::size_t i = 1; i < path.X_WC.size(); ++i)
    out += (path.X_WC[i].translation() - path.X_WC[i - 1].translation()).norm();
  return out;
}

void set_swept(const calibrate::SweptScan& swept, v1::FuseReport& out) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : swept.mesh.points_mm) box.extend(p);
  const scan::Path& path = swept.path;
  out.set_frames_tracked(static_cast<std::int32_t>(path.X_WC.size() - path.lost()));
  out.set_frames_lost(static_cast<std::int32_t>(path.lost()));
  out.set_rms_mm(path.rms_mm);
  out.set_path_mm(length_mm(path));
  out.mutable_mesh()->set_vertices(static_cast<std::int32_t>(swept.mesh.points_mm.size()));
  out.mutable_mesh()->set_triangles(static_cast<std::int32_t>(swept.mesh.triangles.size()));
  add_all(box.min(), out.mutable_min_mm());
  add_all(box.max(), out.mutable_max_mm());
  out.set_frame(swept.film_frame ? "film" : "camera at its first frame");
  if (swept.film_frame) set_film_frame(*swept.film_frame, *out.mutable_film_frame());
}

class Fuse final : public ReportTask<v1::FuseReport> {
 public:
  explicit Fuse(FuseOptions options) : ReportTask("fuse"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override { return options_.frames.string(); }
  [[nodiscard]] std::string memory_tip() const override { return "a larger --voxel-mm"; }
  [[nodiscard]] std::vector<Stage> stages() const override {
    return {{"inputs", 1},  {"reading", 8}, {"following", 45}, {"fusing", 30},
            {"markers", 4}, {"surface", 4}, {"pictures", 6},   {"writing", 2}};
  }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    std::vector<InputPath> out = {{"layout", options_.layout}, {"camera", options_.camera}};
    append_frames(out, {options_.frames});
    return out;
  }

  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;

  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override;

 private:
  FuseOptions options_;
  calibrate::SweptScan swept_;
};

Status Fuse::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  HP_RETURN_IF_ERROR(check_cancelled(context));
  context.progress("reading", 0);
  calibrate::SweptTask task;
  if (!options_.layout.empty()) {
    HP_ASSIGN_OR_RETURN(task.layout, calibrate::read_layout(options_.layout));
  }
  HP_ASSIGN_OR_RETURN(const Scan scan, read_scan(options_.frames, options_.camera, context));
  task.frames = scan.frames.frames;
  task.times_s = scan.frames.times_s;
  task.camera = scan.camera;
  task.volume.voxel_mm = options_.voxel_mm;
  auto found = calibrate::fuse_swept(task, context);
  if (!found) {
    found.error().message.insert(0, options_.frames.string() + ": ");
    return tl::unexpected(std::move(found).error());
  }
  swept_ = std::move(*found);
  report_.set_voxel_mm(options_.voxel_mm);
  set_swept(swept_, report_);
  add_warnings(swept_.warnings, *run.mutable_warnings());
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(write_picture(folder.partial() / "scan.png", swept_.mesh, context));
  context.progress("writing", 0);
  HP_RETURN_IF_ERROR(write_scan(folder.partial() / "scan.ply", swept_.mesh));
  HP_RETURN_IF_ERROR(image::write_artifact(folder.partial() / "camera_path.csv",
                                           path_csv(swept_.path, scan.frames.times_s)));
  for (const char* name : {"scan.ply", "scan.png", "camera_path.csv"}) run.add_artifacts(name);
  return {};
}

std::string Fuse::summary(const std::filesystem::path& dir) const {
  return fmt::format(
      "{}{} frames, {} of them not registered; residual of the smoothed frames {:.2f} mm (rms); "
      "surface of {} triangles\n",
      artifacts_line(dir, report_.run()), swept_.path.X_WC.size(), swept_.path.lost(),
      swept_.path.rms_mm, swept_.mesh.triangles.size());
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& inputs) {
  HP_ASSIGN_OR_RETURN(FuseOptions options,
                      read_options(static_cast<const v1::FuseSpec&>(spec), inputs));
  return std::make_unique<Fuse>(std::move(options));
}

}  // namespace

Verb fuse_verb() {
  return {"fuse",    "Compute a surface from the depth frames of a camera swept by hand",
          kExamples, &v1::FuseSpec::default_instance(),
          add_flags, plan};
}

}  // namespace hydroprint::worker
