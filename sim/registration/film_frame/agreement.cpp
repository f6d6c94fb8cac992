#include "sim/registration/film_frame/agreement.h"

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>

namespace hydroprint::registration {
namespace {

constexpr double kPlaced_mm = 0.2;         ///< accuracy of the markers' positions and of the lens
constexpr double kNormalQuantile = 3.719;  ///< 99.99 % quantile of the normal distribution
constexpr int kSteps = 5;

struct Spot {
  std::size_t marker;  ///< index in the layout
  Eigen::Vector3d layout_F, found_C;
  Eigen::Matrix3d covariance;
};

std::vector<Spot> spots_of(const Matching& matching, const std::vector<FoundMarker>& found,
                           const MarkerLayout& layout) {
  std::vector<Spot> out;
  for (std::size_t a = 0; a < matching.found.size(); ++a) {
    if (matching.found[a] < 0) continue;
    const FoundMarker& marker = found[static_cast<std::size_t>(matching.found[a])];
    const Matrix6 shift = recentred(marker.fit.centre_mm, marker.place_C());
    const Matrix6 there = shift * marker.fit.covariance * shift.transpose();
    out.push_back(
        {a, layout.markers[a].X_FM.translation(), marker.place_C(),
         there.bottomRightCorner<3, 3>() + kPlaced_mm * kPlaced_mm * Eigen::Matrix3d::Identity()});
  }
  return out;
}

/// A pose, and chi-square of the spots at that pose.
struct Settled {
  Pose X_CF;
  double square = 0;
};

Settled settled(const std::vector<Spot>& spots, Pose pose) {
  double square = 0;
  for (int step = 0; step < kSteps; ++step) {
    Matrix6 matrix = Matrix6::Zero();
    Vector6 right = Vector6::Zero();
    const Eigen::Vector3d centre = pose * spots.front().layout_F;
    square = 0;
    for (const Spot& spot : spots) {
      const Eigen::Vector3d at = pose * spot.layout_F, off = spot.found_C - at;
      Eigen::Matrix<double, 3, 6> moves;
      moves << -cross_matrix(at - centre), Eigen::Matrix3d::Identity();
      const Eigen::Matrix3d weight = spot.covariance.inverse();
      matrix += moves.transpose() * weight * moves;
      right += moves.transpose() * weight * off;
      square += off.dot(weight * off);
    }
    if (step + 1 < kSteps) pose = motion(matrix.ldlt().solve(right), centre) * pose;
  }
  return {pose, square};
}

/// Returns whether chi-square is below its 99.99 % quantile (Wilson and Hilferty 1931).
bool is_chance(double square, std::size_t spots) {
  const double freedom = 3 * static_cast<double>(spots) - 6, share = 2 / (9 * freedom);
  return square < freedom * std::pow(1 - share + kNormalQuantile * std::sqrt(share), 3);
}

std::vector<Spot> without(std::vector<Spot> spots, std::size_t i) {
  spots.erase(spots.begin() + static_cast<std::ptrdiff_t>(i));
  return spots;
}

}  // namespace

Matching agreeing(Matching matching, const std::vector<FoundMarker>& found,
                  const MarkerLayout& layout) {
  auto spots = spots_of(matching, found, layout);
  Settled all = settled(spots, matching.X_CF);
  while (spots.size() > 3 && !is_chance(all.square, spots.size())) {
    std::size_t outlier = 0;
    Settled best{all.X_CF, INFINITY};
    for (std::size_t i = 0; i < spots.size(); ++i) {
      const Settled others = settled(without(spots, i), all.X_CF);
      if (others.square >= best.square) continue;
      best = others;
      outlier = i;
    }
    matching.found[spots[outlier].marker] = -1;
    spots = without(spots, outlier);
    all = best;
  }
  matching.X_CF = all.X_CF;
  matching.agrees = is_chance(all.square, spots.size());
  return matching;
}

}  // namespace hydroprint::registration
