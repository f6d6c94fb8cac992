#include "sim/scan/tracking.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

namespace hydroprint::scan {
namespace {

using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr int kBlock_px = 4;
constexpr double kSteepest = 3;    ///< largest slope of a surface to the image plane
constexpr int kFewestOfBlock = 8;  ///< minimum number of pixels with a depth
constexpr double kReach_mm = 3;    ///< distance of the points from which a gradient is computed
constexpr double kHuberSigmas = 2;
constexpr double kLever_mm = 200;  ///< lever arm by which turns are converted to mm
constexpr double kSettled_mm = 0.005;
constexpr int kIterations = 15;
constexpr std::size_t kChunk = 512;

// Limits for accepting a pose.
constexpr double kLeastShare = 0.5;  ///< fraction of the points that must be matched
constexpr double kMostSigma_mm = 1;
/// Maximum rms distance of the matches in standard deviations; smoothed frames have 0.3 to 0.4.
constexpr double kMostRmsSigmas = 0.8;
constexpr double kStillMoves_mm = 0.2;  ///< maximum step of the last iteration

/// Normal equations for a small motion (translation, turn times kLever_mm) of matched points.
struct Equations {
  Matrix6d A = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double squares_mm2 = 0;
  double squares = 0;  ///< sum of squared distances, in units of their variances
  int matched = 0;

  void add(const Vector3d& lever, const Volume::Slope& slope, double sigma_mm) {
    const double sigmas = std::abs(slope.distance_mm) / sigma_mm;
    const double weight =
        (sigmas > kHuberSigmas ? kHuberSigmas / sigmas : 1) / (sigma_mm * sigma_mm);
    Vector6d row;
    row << slope.gradient, lever.cross(slope.gradient) / kLever_mm;
    A += weight * row * row.transpose();
    b -= weight * slope.distance_mm * row;
    squares_mm2 += slope.distance_mm * slope.distance_mm;
    squares += sigmas * sigmas;
    ++matched;
  }

  Equations& operator+=(const Equations& other) {
    A += other.A;
    b += other.b;
    squares_mm2 += other.squares_mm2;
    squares += other.squares;
    matched += other.matched;
    return *this;
  }
};

/// A frame's points and the volume that they are matched with.
struct Match {
  const std::vector<Vector3d>& points;
  const DepthNoise& noise;
  const Volume& volume;
  Vector3d middle_C;  ///< middle of the points

  [[nodiscard]] Equations part(const Pose& X_WC, std::size_t from) const {
    Equations out;
    const Vector3d middle_W = X_WC * middle_C;
    for (std::size_t i = from; i < std::min(points.size(), from + kChunk); ++i) {
      const Vector3d p_W = X_WC * points[i];
      const auto slope = volume.slope(p_W, kReach_mm);
      if (slope) out.add(p_W - middle_W, *slope, noise.sigma_mm(points[i].z()));
    }
    return out;
  }
};

Result<Equations> match(const Match& with, const Pose& X_WC, const Context& context) {
  std::vector<Equations> parts((with.points.size() + kChunk - 1) / kChunk);
  HP_RETURN_IF_ERROR(parallel_for(context, "", parts.size(), [&](std::size_t i) -> Status {
    parts[i] = with.part(X_WC, i * kChunk);
    return {};
  }));
  Equations all;  // the order of the sum does not depend on the number of threads
  for (const Equations& part : parts) all += part;
  return all;
}

/// Returns the standard error of the motion in the direction that the matches determine worst.
double worst_sigma_mm(const Equations& equations) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(equations.A, Eigen::EigenvaluesOnly);
  const double least = eigen.eigenvalues()[0];
  return least > 0 ? 1 / std::sqrt(least) : INFINITY;
}

tl::unexpected<Error> lost() {
  return fail(Code::kFailedPrecondition,
              "tracking of the camera failed. Sweep more slowly, and keep the markers in view",
              ErrorReason::CAMERA_LOST);
}

Pose moved(const Pose& X_WC, const Vector6d& step, const Vector3d& middle_W) {
  const Vector3d turn = step.tail<3>() / kLever_mm;
  Pose out = X_WC;
  if (turn.norm() > 0) {
    const Eigen::AngleAxisd turned(turn.norm(), turn.normalized());
    out.linear() = turned * X_WC.linear();
    out.translation() = middle_W + turned * (X_WC.translation() - middle_W);
  }
  out.translation() += step.head<3>();
  return out;
}

Vector3d block_mean(const DepthFrame& frame, const Optics& optics, int u, int v) {
  Vector3d sum = Vector3d::Zero();
  float least = INFINITY, most = 0;
  int count = 0;
  for (int dv = 0; dv < kBlock_px; ++dv) {
    for (int du = 0; du < kBlock_px; ++du) {
      const std::size_t i = frame.index(u + du, v + dv);
      const float depth = frame.depth_mm[i];
      if (!(depth > 0)) continue;
      least = std::min(least, depth);
      most = std::max(most, depth);
      sum += optics.lens.true_depth_mm(depth) * optics.rays[i];
      ++count;
    }
  }
  if (count < kFewestOfBlock) return Vector3d::Zero();
  const double steepest_mm = kSteepest * kBlock_px * most / optics.lens.fx_px;
  return most - least < steepest_mm ? Vector3d(sum / count) : Vector3d::Zero();
}

}  // namespace

std::vector<Vector3d> tracking_points(const DepthFrame& frame, const Optics& optics) {
  std::vector<Vector3d> out;
  for (int v = 0; v + kBlock_px <= frame.height_px; v += kBlock_px) {
    for (int u = 0; u + kBlock_px <= frame.width_px; u += kBlock_px) {
      const Vector3d mean = block_mean(frame, optics, u, v);
      if (mean.z() > 0) out.push_back(mean);
    }
  }
  return out;
}

Result<Tracked> track(const std::vector<Vector3d>& points, const DepthNoise& noise,
                      const Volume& volume, const Pose& guess, const Context& context) {
  if (points.empty()) return lost();
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : points) sum += p;
  const Match with{points, noise, volume, sum / static_cast<double>(points.size())};
  Pose X_WC = guess;
  Equations equations;
  double step_mm = INFINITY;
  for (int i = 0; i < kIterations && step_mm > kSettled_mm; ++i) {
    HP_ASSIGN_OR_RETURN(equations, match(with, X_WC, context));
    if (!(worst_sigma_mm(equations) < kMostSigma_mm)) return lost();
    const Vector6d step = equations.A.ldlt().solve(equations.b);
    X_WC = moved(X_WC, step, X_WC * with.middle_C);
    step_mm = step.norm();
  }
  const double matched = equations.matched;
  const Tracked out{X_WC, matched / static_cast<double>(points.size()),
                    std::sqrt(equations.squares_mm2 / matched), worst_sigma_mm(equations)};
  const double rms_sigmas = std::sqrt(equations.squares / matched);
  if (out.matched_share < kLeastShare || rms_sigmas > kMostRmsSigmas || step_mm > kStillMoves_mm)
    return lost();
  return out;
}

}  // namespace hydroprint::scan
