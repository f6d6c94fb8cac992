#include "sim/scan/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "sim/base/check.h"
#include "sim/scan/check_frames.h"
#include "sim/scan/depth_steps.h"
#include "sim/scan/smooth.h"

namespace hydroprint::scan {
namespace {

constexpr double kFarthest_mm = 1500;   ///< farther depths belong to the room, not to the rig
constexpr double kRoundAbout_mm = 300;  ///< margin of the volume around the first frame's points
/// The image counts as black if a smaller fraction of its pixels has a depth.
constexpr double kDarkShare = 0.02;
/// This many lost frames in a row fail the sweep: a third of a second at 30 frames/s.
constexpr std::size_t kMostLost = 10;
constexpr std::size_t kTakeEvery = 3;  ///< all frames are registered, but only every third is fused
constexpr Volume::Options kToFollow{3, 12, 60000};

Status check(const SweepTask& task) {
  HP_RETURN_IF_ERROR(check_frames(task.frames));
  const DepthFrame& first = task.frames.front();
  if (first.width_px != task.camera.lens.width_px || first.height_px != task.camera.lens.height_px)
    return fail(Code::kInvalidArgument,
                "the lens calibration is for another resolution. Calibrate the camera at the "
                "resolution of the frames");
  if (task.times_s.size() != task.frames.size() ||
      std::adjacent_find(task.times_s.begin(), task.times_s.end(), std::greater_equal<>()) !=
          task.times_s.end())
    return fail(Code::kInvalidArgument,
                "the times of the frames are missing or do not increase. Record the frames again");
  return task.camera.pattern.check_for(first.width_px, first.height_px, task.noise);
}

/// Provides single frames. Undoes rounding, subtracts the camera's fixed pattern and drops depths
/// of kFarthest_mm and more.
class Source {
 public:
  explicit Source(const SweepTask& task) : task_(task), steps_(find_depth_steps(task.frames)) {}

  [[nodiscard]] DepthFrame frame(std::size_t i) const {
    DepthFrame out = task_.frames[i];
    for (int v = 0; v < out.height_px; ++v) {
      for (int u = 0; u < out.width_px; ++u) {
        float& depth = out.depth_mm[out.index(u, v)];
        depth = is_near(depth) ? as_seen_mm(u, v, depth) : 0;
      }
    }
    return out;
  }

 private:
  [[nodiscard]] bool is_near(float reported_mm) const {
    return reported_mm > 0 && task_.camera.lens.true_depth_mm(reported_mm) < kFarthest_mm;
  }
  [[nodiscard]] float as_seen_mm(int u, int v, float reported_mm) const {
    const float depth_mm = steps_ ? steps_->before_rounding_mm(reported_mm) : reported_mm;
    return static_cast<float>(task_.camera.pattern.taken_off_mm(u, v, depth_mm, task_.noise));
  }

  const SweepTask& task_;
  std::optional<DepthSteps> steps_;
};

Result<Eigen::AlignedBox3d> box_of(const DepthFrame& first, const Optics& optics) {
  Eigen::AlignedBox3d box;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < optics.rays.size(); ++i) {
    if (first.depth_mm[i] <= 0) continue;
    ++seen;
    box.extend(optics.lens.true_depth_mm(first.depth_mm[i]) * optics.rays[i]);
  }
  if (static_cast<double>(seen) < kDarkShare * static_cast<double>(optics.rays.size()))
    return fail(Code::kFailedPrecondition,
                "the camera sees nothing. Uncover it, and begin at a distance of 0.6 to 1.2 m",
                ErrorReason::CAMERA_BLACK);
  const Eigen::Vector3d about = Eigen::Vector3d::Constant(kRoundAbout_mm);
  return Eigen::AlignedBox3d(box.min() - about, box.max() + about);
}

bool is_taken(const Path& path, std::size_t frame) {
  return frame % kTakeEvery == 0 && path.is_placed[frame];
}

bool is_lost_for_good(const Path& path) {
  const auto latest = std::find(path.is_placed.rbegin(), path.is_placed.rend(), true);
  return static_cast<std::size_t>(latest - path.is_placed.rbegin()) >= kMostLost;
}

/// Extrapolates the motion between the last two frames to the next time.
Pose foreseen(const std::vector<Pose>& X_WC, std::span<const double> times_s) {
  HP_CHECK(!X_WC.empty());
  HP_CHECK(X_WC.size() < times_s.size());
  const std::size_t next = X_WC.size();
  const Pose& last = X_WC.back();
  if (next == 1) return last;
  const double share =
      (times_s[next] - times_s[next - 1]) / (times_s[next - 1] - times_s[next - 2]);
  const Pose step = X_WC[next - 2].inverse() * last;
  const Eigen::AngleAxisd turn(step.linear());
  Pose out = last * Eigen::Translation3d(share * step.translation());
  out.rotate(Eigen::AngleAxisd(share * turn.angle(), turn.axis()));
  return out;
}

Error with_frame(Error error, const SweepTask& task, std::size_t frame) {
  error.message =
      fmt::format("depth frame {} of {} (at {:.1f} s): {}", frame + 1, task.frames.size(),
                  task.times_s[frame] - task.times_s[0], error.message);
  return error;
}

double share_of(std::size_t frame, const SweepTask& task) {
  return static_cast<double>(frame) / static_cast<double>(task.frames.size());
}

/// Registers a frame. The first frame defines W. For later ones, first tries the extrapolated pose
/// and then the previous pose.
Result<Tracked> find_place(const DepthFrame& frame, const SweepTask& task, const Optics& optics,
                           const Volume& volume, const Path& path, const Context& context) {
  if (path.X_WC.empty()) return Tracked{};
  const auto points = tracking_points(frame, optics);
  const Pose ahead = foreseen(path.X_WC, task.times_s);
  auto found = track(points, task.noise, volume, ahead, context);
  if (!found && found.error().reason == ErrorReason::CAMERA_LOST)
    found = track(points, task.noise, volume, path.X_WC.back(), context);
  return found;
}

/// Registers the next frame and appends it to the path.
/// @return rms distance of the frame from the volume; 0 if it is not registered
Result<double> place(const DepthFrame& frame, const SweepTask& task, const Optics& optics,
                     const Volume& volume, Path& path, const Context& context) {
  const auto found = find_place(frame, task, optics, volume, path, context);
  if (!found && found.error().reason != ErrorReason::CAMERA_LOST)
    return tl::unexpected(found.error());
  path.X_WC.push_back(found ? found->X_WC : path.X_WC.back());
  path.is_placed.push_back(found.has_value());
  if (is_lost_for_good(path))
    return tl::unexpected(with_frame(found.error(), task, path.X_WC.size() - 1));
  return found ? found->rms_mm : 0;
}

/// Registers every frame to the frames before it.
Result<Path> follow(const SweepTask& task, const Source& source, const Optics& optics,
                    const Eigen::AlignedBox3d& box, const Context& context) {
  Volume volume(box, kToFollow);
  Path out;
  double squares_mm2 = 0;
  for (std::size_t i = 0; i < task.frames.size(); ++i) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    context.progress("following", share_of(i, task));
    HP_ASSIGN_OR_RETURN(const DepthFrame frame, smooth(source.frame(i), task.noise, context));
    HP_ASSIGN_OR_RETURN(const double rms_mm, place(frame, task, optics, volume, out, context));
    squares_mm2 += rms_mm * rms_mm;
    if (is_taken(out, i))
      HP_RETURN_IF_ERROR(volume.add(frame, optics, task.noise, out.X_WC[i], context));
  }
  out.rms_mm = std::sqrt(squares_mm2 / static_cast<double>(out.X_WC.size() - out.lost()));
  return out;
}

}  // namespace

Result<Sweep> fuse_sweep(const SweepTask& task, const Context& context) {
  HP_RETURN_IF_ERROR(check(task));
  const Source source(task);
  const Optics optics(task.camera.lens);
  HP_ASSIGN_OR_RETURN(const Eigen::AlignedBox3d box, box_of(source.frame(0), optics));
  HP_ASSIGN_OR_RETURN(const Path path, follow(task, source, optics, box, context));
  Sweep out{Volume(box, task.volume), path, 0};
  for (std::size_t i = 0; i < task.frames.size(); ++i) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    context.progress("fusing", share_of(i, task));
    if (!is_taken(path, i)) continue;
    HP_RETURN_IF_ERROR(out.volume.add(source.frame(i), optics, task.noise, path.X_WC[i], context));
    ++out.fused;
  }
  return out;
}

}  // namespace hydroprint::scan
