#include "sim/registration/pose_fit.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sim/registration/pairs.h"
#include "sim/registration/robust.h"

namespace hydroprint::registration {
namespace {

constexpr std::size_t kFewestPairs = 30;
constexpr double kLeastReach_mm = 5;
constexpr double kReachShrinks = 0.8;
constexpr double kSettled_mm = 1e-3, kNearlySettled_mm = 0.1;
constexpr double kMostStep_mm = 10;
/// Information below this fraction of the largest is rounding error.
constexpr double kNil = 1e-12;
constexpr double kOnSurface = 0.3;  ///< robust weight above which a point counts as on the surface

/// The noise for detecting outliers: that of a camera with an unknown fixed pattern (kUsual), or
/// this camera's own, which may be smaller (kOwn). The fit first converges with kUsual. Far from
/// the solution, kOwn would drop the few points of a narrow face permanently, and with them the
/// motions that only these points determine.
enum class NoiseModel { kUsual, kOwn };

/// Residuals in units of noise, and their robust weights.
struct WeightedResiduals {
  std::vector<double> off, weights;
  double spread = 1;
};

WeightedResiduals weighted_residuals(std::span<const Pair> pairs, NoiseModel noise) {
  WeightedResiduals out;
  out.off.reserve(pairs.size());
  for (const Pair& pair : pairs)
    out.off.push_back(pair.residual_mm /
                      (noise == NoiseModel::kOwn ? pair.sigma_mm() : pair.usual_sigma_mm()));
  out.spread = spread_of(out.off);
  out.weights.reserve(pairs.size());
  for (const double off : out.off) out.weights.push_back(robust_weight(off, out.spread));
  return out;
}

/// Up to six orthonormal directions of motion, one per column.
using Directions = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using UpToSix = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

/// The normal equations along their eigenvectors.
struct Split {
  Directions directions;  ///< eigenvectors
  UpToSix information;
  UpToSix sigma_mm;
  Eigen::Array<bool, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1> weak;

  /// Returns the pseudo-inverse of the information, without the weak directions.
  [[nodiscard]] Matrix6 inverse() const {
    const UpToSix each = weak.select(0, information.array().inverse()).matrix();
    return directions * each.asDiagonal() * directions.transpose();
  }
  /// Returns the projection onto the weak directions.
  [[nodiscard]] Matrix6 onto_weak() const {
    const UpToSix each = weak.cast<double>().matrix();
    return directions * each.asDiagonal() * directions.transpose();
  }
};

/// @param free        the directions in which the pose can be determined at all
/// @param weak_count  number of weak directions once it is final; the directions with the largest
///                    errors are weak. Directions without any information are always weak
Split split(const Normals& normals, const Directions& free, double weak_sigma_mm,
            std::optional<Eigen::Index> weak_count = {}) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(free.transpose() *
                                                              normals.information * free);
  const Eigen::Index count = free.cols();
  Split out{free * solver.eigenvectors(), solver.eigenvalues(), UpToSix::Zero(count), {}};
  const double nil = kNil * std::max(1.0, out.information.maxCoeff());
  for (Eigen::Index k = 0; k < count; ++k) {
    const Vector6 e = out.directions.col(k);
    const double information = std::max(out.information[k], nil);
    out.sigma_mm[k] = std::sqrt(std::max(0.0, e.dot(normals.scatter * e))) / information;
    // Without noise the scatter is 0, so the information also limits the error.
    const double at_least = 1 / std::sqrt(information);
    out.sigma_mm[k] = std::max(out.sigma_mm[k], at_least);
  }
  UpToSix sorted = out.sigma_mm;
  std::sort(sorted.begin(), sorted.end());
  // A direction near the limit must not change between weak and strong from step to step.
  if (weak_count)
    weak_sigma_mm = *weak_count >= count ? 0
                    : *weak_count == 0   ? INFINITY
                                         : sorted[count - 1 - *weak_count];
  // Without any information a step along the direction is impossible.
  out.weak = out.sigma_mm.array() > weak_sigma_mm || out.information.array() <= nil;
  return out;
}

/// Turns about axes through the centre, in the scaled coordinates of the normal equations.
Directions turns_about(std::span<const Eigen::Vector3d> axes) {
  Directions out = Directions::Zero(6, static_cast<Eigen::Index>(axes.size()));
  for (std::size_t k = 0; k < axes.size(); ++k)
    out.col(static_cast<Eigen::Index>(k)).head<3>() = axes[k];
  return out;
}

/// Returns the directions that are perpendicular to all of the given ones.
Directions complement(const Directions& given) {
  if (given.cols() == 0) return Matrix6::Identity();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(given);
  const Matrix6 all = qr.householderQ() * Matrix6::Identity();
  return all.rightCols(6 - given.cols());
}

/// The pairs at one pose, with their weights and normal equations.
struct LinearSystem {
  std::vector<Pair> pairs;
  WeightedResiduals residuals;
  Eigen::Vector3d centre;
  Normals normals;
};

class Fitter {
 public:
  Fitter(const Shape& shape, std::span<const scan::ScanPoint> points, const scan::Camera& camera,
         const Pose& nominal_CB, const FitOptions& options, const Context& context)
      : shape_(shape),
        points_(points),
        camera_(camera),
        nominal_(nominal_CB),
        options_(options),
        context_(context),
        length_mm_(shape.radius_mm()) {}

  Result<PoseFit> fit(const Pose& start) const {
    Iterate iterate{start, std::max(options_.reach_mm, kLeastReach_mm), {}};
    if (camera_.pattern.is_known()) HP_RETURN_IF_ERROR(settle(iterate, NoiseModel::kUsual));
    iterate.weak.reset();
    HP_RETURN_IF_ERROR(settle(iterate, NoiseModel::kOwn));
    HP_ASSIGN_OR_RETURN(LinearSystem system,
                        linear_system_at(iterate.pose, iterate.reach, NoiseModel::kOwn));
    return result(system, iterate.pose, iterate.weak);
  }

 private:
  /// State of the iteration.
  struct Iterate {
    Pose pose;
    double reach;
    std::optional<Eigen::Index> weak;  ///< number of weak directions, once it is settled
  };

  Status settle(Iterate& iterate, NoiseModel noise) const {
    auto& [pose, reach, weak] = iterate;
    for (int i = 0; i < options_.most_iterations; ++i) {
      HP_RETURN_IF_ERROR(check_cancelled(context_));
      HP_ASSIGN_OR_RETURN(const LinearSystem system, linear_system_at(pose, reach, noise));
      const Split parts = split_at(pose, system.normals, weak);
      const Vector6 step = step_of(system, parts, pose);
      pose = motion(unscaled(step), system.centre) * pose;
      const bool at_reach = reach <= kLeastReach_mm;
      reach = std::max(kLeastReach_mm, kReachShrinks * reach);
      if (!at_reach) continue;
      if (step.norm() < kSettled_mm) break;
      if (step.norm() < kNearlySettled_mm) weak = parts.weak.count();
    }
    return {};
  }

  /// Returns the turns that leave the surface in place, at a pose.
  [[nodiscard]] Directions symmetries_at(const Pose& pose) const {
    std::vector<Eigen::Vector3d> axes_C;
    for (const Eigen::Vector3d& axis : options_.symmetry_axes)
      axes_C.emplace_back(pose.linear() * axis);
    return turns_about(axes_C);
  }

  [[nodiscard]] Split split_at(const Pose& pose, const Normals& normals,
                               std::optional<Eigen::Index> weak_count) const {
    return split(normals, complement(symmetries_at(pose)), options_.weak_sigma_mm, weak_count);
  }

  static Pairing pairing_at(double reach) {
    return reach > kLeastReach_mm ? Pairing::kNearest : Pairing::kOnRay;
  }

  Result<LinearSystem> linear_system_at(const Pose& pose, double reach, NoiseModel noise) const {
    LinearSystem out;
    HP_ASSIGN_OR_RETURN(out.pairs,
                        pair_up(shape_, points_, pose, pairing_at(reach), reach, context_));
    if (out.pairs.size() < kFewestPairs)
      return fail(Code::kFailedPrecondition,
                  fmt::format("only {} scan points lie near the surface. Check that the surface is "
                              "in the camera's view",
                              out.pairs.size()),
                  ErrorReason::TOO_FEW_POINTS);
    out.residuals = weighted_residuals(out.pairs, noise);
    out.centre = pose * shape_.centroid();
    out.normals = normal_equations(out.pairs, out.residuals.weights, out.centre, length_mm_);
    return out;
  }

  [[nodiscard]] Vector6 scale() const {
    return (Vector6() << Eigen::Vector3d::Constant(1 / length_mm_), Eigen::Vector3d::Ones())
        .finished();
  }
  [[nodiscard]] Vector6 unscaled(const Vector6& step) const { return scale().cwiseProduct(step); }

  /// Returns the Gauss-Newton step, and along weak directions and symmetries the step to the
  /// nominal pose.
  [[nodiscard]] Vector6 step_of(const LinearSystem& system, const Split& parts,
                                const Pose& pose) const {
    const Vector6 to_nominal = twist_between(pose, nominal_, system.centre).cwiseQuotient(scale());
    const Directions symmetries = symmetries_at(pose);
    const Matrix6 from_nominal = parts.onto_weak() + symmetries * symmetries.transpose();
    const Vector6 step = parts.inverse() * system.normals.pull + from_nominal * to_nominal;
    return step * std::min(1.0, kMostStep_mm / std::max(step.norm(), 1e-300));
  }

  [[nodiscard]] PoseFit result(LinearSystem& system, const Pose& pose,
                               const std::optional<Eigen::Index>& weak) const {
    add_camera(system.normals, system.pairs, system.residuals.weights, system.centre, length_mm_,
               camera_);
    // If residuals exceed their noise, the error of the result grows by the same factor.
    system.normals.scatter *= system.residuals.spread * system.residuals.spread;
    const Split parts = split_at(pose, system.normals, weak);
    const Matrix6 inverse = parts.inverse(), onto_weak = parts.onto_weak();
    Vector6 nominal;
    nominal << Eigen::Vector3d::Constant(options_.nominal_turn_sigma_rad * length_mm_),
        Eigen::Vector3d::Constant(options_.nominal_shift_sigma_mm);
    const Matrix6 scaled = inverse * system.normals.scatter * inverse +
                           onto_weak * nominal.cwiseAbs2().asDiagonal() * onto_weak;
    PoseFit out;
    out.X_CB = pose;
    out.centre_mm = system.centre;
    out.covariance = scale().asDiagonal() * scaled * scale().asDiagonal();
    out.camera_gain = scale().asDiagonal() * (inverse * system.normals.camera);
    for (Eigen::Index k = 0; k < parts.weak.size(); ++k)
      if (parts.weak[k]) out.weak.push_back({unscaled(parts.directions.col(k)), parts.sigma_mm[k]});
    judge(system.pairs, out);
    return out;
  }

  /// Sets the number, share and rms distance of the points on the surface. Uses kUsual, so that the
  /// criteria for a match do not depend on how well the camera is calibrated.
  void judge(std::span<const Pair> pairs, PoseFit& out) const {
    const WeightedResiduals usual = weighted_residuals(pairs, NoiseModel::kUsual);
    double squares_mm = 0, squares = 0;
    std::size_t on = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (usual.weights[i] < kOnSurface) continue;
      ++on;
      squares_mm += pairs[i].residual_mm * pairs[i].residual_mm;
      squares += usual.off[i] * usual.off[i];
    }
    const auto count = static_cast<double>(std::max<std::size_t>(on, 1));
    out.points = on;
    out.paired_share = static_cast<double>(on) / static_cast<double>(points_.size());
    out.rms_mm = std::sqrt(squares_mm / count);
    out.rms_sigmas = std::sqrt(squares / count);
  }

  const Shape& shape_;
  std::span<const scan::ScanPoint> points_;
  const scan::Camera& camera_;
  const Pose& nominal_;
  const FitOptions& options_;
  const Context& context_;
  double length_mm_;
};

std::string text(const Eigen::Vector3d& v, int digits) {
  return fmt::format("({1:.{0}f}, {2:.{0}f}, {3:.{0}f})", digits, v.x() + 0.0, v.y() + 0.0,
                     v.z() + 0.0);
}

}  // namespace

Result<PoseFit> fit_pose(const Shape& shape, std::span<const scan::ScanPoint> points,
                         const scan::Camera& camera, const Pose& start_CB, const Pose& nominal_CB,
                         const FitOptions& options, const Context& context) {
  return Fitter(shape, points, camera, nominal_CB, options, context).fit(start_CB);
}

std::vector<double> error_at(std::span<const Eigen::Vector3d> points_mm,
                             const Eigen::Vector3d& centre_mm, const Matrix6& covariance) {
  std::vector<double> out;
  out.reserve(points_mm.size());
  for (const Eigen::Vector3d& p : points_mm) {
    const Matrix6 there =
        recentred(centre_mm, p) * covariance * recentred(centre_mm, p).transpose();
    out.push_back(std::sqrt(std::max(0.0, there.bottomRightCorner<3, 3>().trace())));
  }
  return out;
}

std::string describe(const WeakDirection& direction, const Eigen::Vector3d& centre_C,
                     const Pose& X_AC) {
  const Eigen::Vector3d turn = direction.twist.head<3>(), shift = direction.twist.tail<3>();
  if (turn.isZero() || shift.norm() > 0.7)  // of the 1 mm by which the twist moves the surface
    return "shift along " + text(X_AC.linear() * shift.normalized(), 2);
  const Eigen::Vector3d on_axis = centre_C + turn.cross(shift) / turn.squaredNorm();
  return "turn about the axis through " + text(X_AC * on_axis, 0) + " along " +
         text(X_AC.linear() * turn.normalized(), 2);
}

std::string describe_symmetry(std::span<const Eigen::Vector3d> axes_B,
                              const Eigen::Vector3d& centroid_B, const Pose& X_AB) {
  if (axes_B.empty()) return "";
  const std::string centre = text(X_AB * centroid_B, 0);
  if (axes_B.size() > 1) return "any turn about " + centre;
  return "turn about the axis through " + centre + " along " +
         text(X_AB.linear() * axes_B.front(), 2);
}

}  // namespace hydroprint::registration
