#include "sim/worker/fuse.h"

#include <Eigen/Geometry>
#include <array>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "sim/calibrate/frames_folder.h"
#include "sim/image/alignment_picture.h"
#include "sim/image/artifact_file.h"
#include "sim/image/image_file.h"
#include "sim/mesh/make_surface.h"
#include "sim/worker/calibrate.h"
#include "sim/worker/surface_ply.h"

namespace hydroprint::worker {
namespace {

/// A camera's path, one line for each frame that has a place: t_s, and its pose in the mesh's
/// frame.
std::string path_csv(const scan::Path& path, const std::vector<double>& times_s) {
  std::string out = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n";
  for (std::size_t i = 0; i < path.X_WC.size(); ++i) {
    if (!path.is_placed[i]) continue;
    const Eigen::Quaterniond q(path.X_WC[i].linear());
    const Eigen::Vector3d p = path.X_WC[i].translation();
    std::array<char, 200> line{};
    std::snprintf(line.data(), line.size(), "%.6f,%.4f,%.4f,%.4f,%.8f,%.8f,%.8f,%.8f\n",
                  times_s[i] - times_s[0], p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
    out += line.data();
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

}  // namespace

std::vector<Stage> fuse_stages() {
  return {{"inputs", 1},  {"reading", 8}, {"following", 45}, {"fusing", 30},
          {"markers", 4}, {"surface", 4}, {"pictures", 6},   {"writing", 2}};
}

Status run_fuse(const Options& options, OutFolder& folder, Report& report, const Context& context) {
  context.progress("reading", 0);
  calibrate::SweptTask task;
  if (!options.layout.empty()) {
    HP_ASSIGN_OR_RETURN(task.layout, calibrate::read_layout(options.layout));
  }
  HP_ASSIGN_OR_RETURN(const calibrate::Frames taken, read_scan(options, task.camera, context));
  task.frames = taken.frames;
  task.times_s = taken.times_s;
  task.volume.voxel_mm = options.voxel_mm;
  auto found = calibrate::fuse_swept(task, context);
  if (!found) {
    found.error().message.insert(0, options.frames.front().string() + ": ");
    return tl::unexpected(std::move(found).error());
  }
  report.warnings = found->warnings;
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(write_picture(folder.partial() / "scan.png", found->mesh, context));
  context.progress("writing", 0);
  HP_RETURN_IF_ERROR(write_scan(folder.partial() / "scan.ply", found->mesh));
  HP_RETURN_IF_ERROR(image::write_artifact(folder.partial() / "camera_path.csv",
                                           path_csv(found->path, taken.times_s)));
  report.artifacts = {"scan.ply", "scan.png", "camera_path.csv"};
  report.swept = std::move(*found);
  return {};
}

}  // namespace hydroprint::worker
