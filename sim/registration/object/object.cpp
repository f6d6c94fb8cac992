#include "sim/registration/object/object.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>
#include <utility>

#include "sim/base/number_text.h"
#include "sim/registration/object/best_fit.h"
#include "sim/registration/object/units.h"
#include "sim/registration/pairs.h"
#include "sim/registration/segments.h"
#include "sim/registration/starts.h"
#include "sim/registration/symmetry.h"

namespace hydroprint::registration {
namespace {

constexpr std::size_t kFewestPoints = 300;
constexpr std::size_t kMostStarts = 5;
constexpr std::size_t kTrialPoints = 1500;
constexpr std::size_t kSightSamples = 2000;
constexpr double kSight_mm = 8;
constexpr double kOn_mm = 4;
constexpr int kBlock_px = 16;
constexpr std::size_t kFewestInBlock = 40;
constexpr double kLeastOnShare = 0.85;
constexpr double kMaxThroughShare = 0.12;
constexpr double kMostMisfit_mm = 1;
/// A connected piece off the mesh with a larger share of the points is a second object.
constexpr double kOtherShare = 0.08;
constexpr double kOtherJump_mm = 12;
constexpr double kMostlySeen = 0.6;
constexpr double kOutOfView = 0.15;
constexpr double kHidden = 0.4;

/// Rms, over blocks of pixels, of the mean distance of a block's points from the mesh.
struct Misfit {
  double rms_mm = 0;
  double blocks = 0;
};

/// A pose and how well it explains the scan.
struct Candidate {
  PoseFit fit;
  Sight sight;
  double on_share = 0;
  double misfit_mm = 0;
  double misfit_blocks = 0;
  double distance_mm = 0;  ///< rms distance of the scan from the mesh; farther points count kOn_mm

  [[nodiscard]] double mismatch() const {
    return 1 - on_share + sight.through + misfit_mm / (10 * kMostMisfit_mm);
  }
  [[nodiscard]] bool explains() const {
    return on_share > kLeastOnShare && sight.through < kMaxThroughShare &&
           misfit_mm < kMostMisfit_mm;
  }
};

Misfit misfit_of(const std::vector<Pair>& pairs, int width_px) {
  struct Block {
    double sum = 0;
    std::size_t count = 0;
  };
  std::unordered_map<int, Block> blocks;
  for (const Pair& pair : pairs) {
    Block& block =
        blocks[pair.scan->v / kBlock_px * (width_px / kBlock_px + 1) + pair.scan->u / kBlock_px];
    block.sum += pair.residual_mm;
    ++block.count;
  }
  double squares = 0, count = 0;
  for (const auto& [place, block] : blocks) {
    if (block.count < kFewestInBlock) continue;
    const double mean = block.sum / static_cast<double>(block.count);
    squares += mean * mean;
    ++count;
  }
  return {count > 0 ? std::sqrt(squares / count) : 0, count};
}

class Finder {
 public:
  Finder(const Shape& shape, const std::vector<scan::ScanPoint>& points,
         const scan::DepthFrame& depth, const scan::Camera& camera, const Pose& nominal_CO,
         const FitOptions& options, const Context& context)
      : shape_(shape),
        points_(points),
        depth_(depth),
        camera_(camera),
        nominal_(nominal_CO),
        options_(options),
        context_(context) {
    options_.symmetry_axes = symmetry_axes(shape);
  }

  Result<Candidate> best() const {
    HP_ASSIGN_OR_RETURN(const auto starts,
                        rough_alignments(shape_, points_, nominal_, kMostStarts, context_));
    std::vector<Candidate> tried;
    for (const Pose& start : starts) {
      HP_RETURN_IF_ERROR(check_cancelled(context_));
      const auto fit = fit_pose(shape_, some(), camera_, start, nominal_, options_, context_);
      if (!fit) continue;
      HP_ASSIGN_OR_RETURN(Candidate candidate, judged(*fit));
      tried.push_back(std::move(candidate));
    }
    if (tried.empty()) return not_this("no orientation of the mesh comes near the scan");
    std::vector<FitQuality> qualities;
    for (const Candidate& candidate : tried) qualities.push_back(quality(candidate));
    const Candidate& chosen = tried[best_fit(qualities)];
    HP_ASSIGN_OR_RETURN(const PoseFit fit, fit_pose(shape_, points_, camera_, chosen.fit.X_CB,
                                                    nominal_, options_, context_));
    return judged(fit);
  }

  /// Returns the symmetry of the mesh in words, in the film frame; see describe_symmetry().
  [[nodiscard]] std::string symmetry(const Pose& X_FO) const {
    return describe_symmetry(options_.symmetry_axes, shape_.centroid(), X_FO);
  }

  [[nodiscard]] static tl::unexpected<Error> not_this(const std::string& why) {
    return fail(Code::kFailedPrecondition,
                "the object in view does not match the mesh: " + why +
                    ". Use the mesh of the object in the gripper",
                ErrorReason::NOT_THIS_OBJECT);
  }

  /// Returns the largest connected piece of points off the mesh, as a fraction of the scan.
  [[nodiscard]] double other_share(const Candidate& candidate, const scan::Cloud& cloud) const {
    std::vector<bool> off(cloud.points.size());
    const Pose X_BC = candidate.fit.X_CB.inverse();
    for (const scan::ScanPoint& p : points_)
      if (distance(X_BC, p) > 2 * kOn_mm)
        off[static_cast<std::size_t>(cloud.at(p.u, p.v) - cloud.points.data())] = true;
    const auto pieces = segments(cloud, off, kOtherJump_mm);
    if (pieces.empty()) return 0;
    return static_cast<double>(pieces[0].size()) / static_cast<double>(points_.size());
  }

 private:
  [[nodiscard]] std::vector<scan::ScanPoint> some() const {
    std::vector<scan::ScanPoint> out;
    const std::size_t step = std::max<std::size_t>(1, points_.size() / kTrialPoints);
    for (std::size_t i = 0; i < points_.size(); i += step) out.push_back(points_[i]);
    return out;
  }

  [[nodiscard]] double distance(const Pose& X_BC, const scan::ScanPoint& p) const {
    const Eigen::Vector3d p_B = X_BC * p.point_mm;
    return (shape_.closest(p_B).point_mm - p_B).norm();
  }

  Result<Candidate> judged(const PoseFit& fit) const {
    Candidate out;
    out.fit = fit;
    out.sight = look_at(visible(shape_, fit.X_CB, kSightSamples), depth_, camera_.lens, kSight_mm);
    const Pose X_BC = fit.X_CB.inverse();
    const auto count = static_cast<double>(points_.size());
    double squares = 0;
    for (const auto& p : points_) {
      const double distance_mm = distance(X_BC, p);
      out.on_share += distance_mm < kOn_mm ? 1 / count : 0;
      squares += std::pow(std::min(distance_mm, kOn_mm), 2);
    }
    out.distance_mm = std::sqrt(squares / count);
    HP_ASSIGN_OR_RETURN(const auto pairs,
                        pair_up(shape_, points_, fit.X_CB, Pairing::kOnRay, kOn_mm, context_));
    const Misfit misfit = misfit_of(pairs, camera_.lens.width_px);
    out.misfit_mm = misfit.rms_mm;
    out.misfit_blocks = misfit.blocks;
    return out;
  }

  [[nodiscard]] FitQuality quality(const Candidate& c) const {
    return {static_cast<double>(some().size()),
            static_cast<double>(c.fit.points),
            c.misfit_mm,
            c.misfit_blocks,
            c.mismatch(),
            c.distance_mm,
            Eigen::AngleAxisd(c.fit.X_CB.linear().transpose() * nominal_.linear()).angle()};
  }

  const Shape& shape_;
  const std::vector<scan::ScanPoint>& points_;
  const scan::DepthFrame& depth_;
  const scan::Camera& camera_;
  const Pose& nominal_;
  FitOptions options_;
  const Context& context_;
};

std::string mismatch_text(const Candidate& c) {
  return fmt::format(
      "at best {} of the scan lies on the mesh, with a misfit of {:.1f} mm (rms), and the camera "
      "sees through {} of the mesh",
      percent(c.on_share), c.misfit_mm, percent(c.sight.through));
}

/// Transforms the pose into the film frame. Adds the uncertainty of that frame and of the camera.
void place_in_film(const FilmFrame& frame, ObjectPose& out) {
  const Pose X_FC = frame.X_CF().inverse();
  const PoseFit& fit = out.fit;
  const Matrix6 shift = recentred(frame.fit.centre_mm, fit.centre_mm);
  const CameraGain gain = fit.camera_gain - frame.camera_gain(shift, fit.camera_gain.cols());
  const Matrix6 in_camera =
      fit.covariance + shift * frame.fit.covariance * shift.transpose() + gain * gain.transpose();
  const Matrix6 turn = turned(X_FC.linear());
  out.X_FO = X_FC * fit.X_CB;
  out.centre_mm = X_FC * fit.centre_mm;
  out.covariance = turn * in_camera * turn.transpose();
  for (const WeakDirection& weak : fit.weak)
    out.weak.push_back(describe(weak, fit.centre_mm, X_FC));
}

tl::unexpected<Error> too_few(std::size_t points, const Surroundings& around) {
  std::string why = "no object is in view above the water. Mount the object, or raise it";
  if (points > 0) {
    why = fmt::format(
        "too little of the object is in view above the water: {} points of at least {}. ", points,
        kFewestPoints);
    why += std::isfinite(around.gripper_from_mm)
               ? fmt::format(
                     "Above {:.0f} mm, all within {:g} mm of the gripper's axis counts as "
                     "the gripper. Hang it lower below the gripper, for example on a rod",
                     around.gripper_from_mm, around.gripper_radius_mm)
               : "Raise it, or move the camera nearer";
  }
  return fail(Code::kFailedPrecondition, why, ErrorReason::NO_OBJECT);
}

void warn(ObjectPose& out) {
  if (out.sight.out_of_view > kOutOfView)
    out.warnings.push_back({WarningCode::OBJECT_PARTLY_OUT_OF_VIEW,
                            percent(out.sight.out_of_view) +
                                " of the surface that faces the camera is out of its view. "
                                "Move the camera",
                            {OfItem{"object"}}});
  if (out.sight.before + out.sight.without_depth > kHidden)
    out.warnings.push_back({WarningCode::OBJECT_PARTLY_HIDDEN,
                            percent(out.sight.before + out.sight.without_depth) +
                                " of the surface that faces the camera is hidden. Move the camera, "
                                "or remove what hides the object",
                            {OfItem{"object"}}});
}

}  // namespace

Result<ObjectPose> find_object(const scan::Cloud& cloud, const scan::DepthFrame& depth,
                               const FilmFrame& film_frame, const ObjectTask& task,
                               const Context& context) {
  const ObjectPoints found = object_points(cloud, film_frame, task.surroundings);
  const auto& points = found.all;
  if (points.size() < kFewestPoints) return too_few(points.size(), task.surroundings);
  const Shape shape(task.surface);
  HP_RETURN_IF_ERROR(check_size(shape, std::span(points).first(found.largest)));
  const Pose nominal_CO = film_frame.X_CF() * task.nominal_FO;
  const Finder finder(shape, points, depth, cloud.camera, nominal_CO, task.fit, context);
  HP_ASSIGN_OR_RETURN(const Candidate best, finder.best());
  const double other = finder.other_share(best, cloud);
  if (other > kOtherShare && best.sight.on > kMostlySeen && best.sight.through < kMaxThroughShare)
    return fail(Code::kFailedPrecondition,
                "a second object is in view (" + percent(other) + " of the scan). Remove it",
                ErrorReason::TWO_OBJECTS);
  if (!best.explains()) {
    const Shape mirror(mirrored(task.surface));
    const auto turned_round =
        Finder(mirror, points, depth, cloud.camera, nominal_CO, task.fit, context).best();
    if (turned_round && turned_round->explains())
      return fail(Code::kFailedPrecondition,
                  "the object is the mesh's mirror image. Export the mesh without mirroring",
                  ErrorReason::MIRRORED);
    return Finder::not_this(mismatch_text(best));
  }
  ObjectPose out;
  out.fit = best.fit;
  out.misfit_mm = best.misfit_mm;
  out.on_share = best.on_share;
  out.sight = best.sight;
  place_in_film(film_frame, out);
  out.symmetry = finder.symmetry(out.X_FO);
  warn(out);
  return out;
}

}  // namespace hydroprint::registration
