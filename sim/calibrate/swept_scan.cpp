#include "sim/calibrate/swept_scan.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "sim/calibrate/calibrate.h"
#include "sim/scan/cloud.h"

namespace hydroprint::calibrate {
namespace {

/// A surface must have the weight of this many frames that saw it from kUsualDepth_mm.
constexpr double kLeastFrames = 3;
constexpr double kUsualDepth_mm = 800;
/// Range of heights above the water within which parts of a rig are kept.
constexpr double kLowest_mm = -40, kHighest_mm = 600;

/// Returns what the camera sees of the volume from the pose of its first frame, as a fused frame of
/// `frames` frames.
scan::FusedFrame first_frame(const scan::PointGrid& seen, const scan::Lens& lens,
                             const scan::DepthNoise& noise, std::size_t frames) {
  const std::size_t pixels = seen.points.size();
  scan::FusedFrame out{{seen.width_px, seen.height_px, std::vector<float>(pixels)},
                       std::vector<float>(pixels),
                       std::vector<std::uint16_t>(pixels)};
  for (std::size_t i = 0; i < pixels; ++i) {
    const double depth_mm = seen.points[i].z() / lens.depth_scale;
    if (depth_mm <= 0) continue;
    out.mean.depth_mm[i] = static_cast<float>(depth_mm);
    out.sigma_mm[i] = static_cast<float>(noise.changing_sigma_mm(depth_mm) /
                                         std::sqrt(static_cast<double>(frames)));
    out.frames[i] = static_cast<std::uint16_t>(frames);
  }
  return out;
}

/// Returns the film frame from the markers in the volume.
Result<registration::FilmFrame> film_frame_of(const scan::Sweep& sweep, const SweptTask& task,
                                              const scan::DepthNoise& noise,
                                              const Context& context) {
  context.progress("markers", 0);
  const scan::Lens& lens = task.camera.lens;
  // The volume is already corrected for the camera's fixed pattern.
  const scan::Camera camera{lens, task.camera.covariance, {}};
  HP_ASSIGN_OR_RETURN(const scan::PointGrid seen,
                      sweep.volume.look(scan::Optics(lens), Pose::Identity(), context));
  HP_ASSIGN_OR_RETURN(
      const scan::Cloud cloud,
      scan::make_cloud(first_frame(seen, lens, noise, sweep.fused), camera, noise, context));
  return registration::find_film_frame(cloud, task.layout->surroundings.layout,
                                       task.layout->nominal_FC.inverse(), context);
}

Warnings lost_frames(const scan::Path& path) {
  if (path.lost() == 0) return {};
  return {
      {WarningCode::FRAMES_LOST,
       fmt::format("{} of {} frames could not be registered and are left out: sweep more slowly",
                   path.lost(), path.X_WC.size()),
       {OfItem{"frames"}}}};
}

void append(Warnings& to, const Warnings& more) { to.insert(to.end(), more.begin(), more.end()); }

/// Returns a box around everything within the bars, which carry the markers.
Eigen::AlignedBox3d rig_box(const registration::MarkerLayout& layout) {
  Eigen::AlignedBox3d out;
  for (const registration::Marker& marker : layout.markers) out.extend(marker.X_FM.translation());
  const Eigen::Vector3d about = Eigen::Vector3d::Constant(layout.width_mm);
  out = {out.min() - about, out.max() + about};
  out.min().z() = kLowest_mm;
  out.max().z() = kHighest_mm;
  return out;
}

/// Returns the triangles whose corners all lie in a box, with their corners.
scan::TriangleMesh within(const scan::TriangleMesh& mesh, const Eigen::AlignedBox3d& box) {
  scan::TriangleMesh out;
  std::vector<int> at(mesh.points_mm.size(), -1);
  const auto is_in = [&](int i) {
    return box.contains(mesh.points_mm[static_cast<std::size_t>(i)]);
  };
  for (Eigen::Vector3i t : mesh.triangles) {
    if (!is_in(t[0]) || !is_in(t[1]) || !is_in(t[2])) continue;
    for (int& corner : t) {
      int& place = at[static_cast<std::size_t>(corner)];
      if (place < 0) {
        place = static_cast<int>(out.points_mm.size());
        out.points_mm.push_back(mesh.points_mm[static_cast<std::size_t>(corner)]);
      }
      corner = place;
    }
    out.triangles.push_back(t);
  }
  return out;
}

}  // namespace

Result<SweptScan> fuse_swept(const SweptTask& task, const Context& context) {
  const scan::DepthNoise noise;
  HP_ASSIGN_OR_RETURN(
      scan::Sweep sweep,
      scan::fuse_sweep({task.frames, task.times_s, task.camera, noise, task.volume}, context));
  SweptScan out;
  out.path = sweep.path;
  out.warnings = camera_warnings(task.camera);
  append(out.warnings, lost_frames(out.path));
  Pose X_FW = Pose::Identity();
  if (task.layout) {
    HP_ASSIGN_OR_RETURN(out.film_frame, film_frame_of(sweep, task, noise, context));
    X_FW = out.film_frame->X_CF().inverse();
    append(out.warnings, out.film_frame->warnings);
  }
  context.progress("surface", 0);
  const double one = noise.sigma_mm(kUsualDepth_mm);
  out.mesh = sweep.volume.surface(kLeastFrames / (one * one));
  for (Eigen::Vector3d& p : out.mesh.points_mm) p = X_FW * p;
  if (task.layout) out.mesh = within(out.mesh, rig_box(task.layout->surroundings.layout));
  for (Pose& pose : out.path.X_WC) pose = X_FW * pose;
  if (out.mesh.triangles.empty())
    return fail(Code::kFailedPrecondition,
                "no surface was seen often enough: sweep longer, at a distance of 0.6 to 1.2 m",
                ErrorReason::NO_SURFACE);
  return out;
}

}  // namespace hydroprint::calibrate
