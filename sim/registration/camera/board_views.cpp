#include "sim/registration/camera/board_views.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "sim/registration/pose_fit.h"
#include "sim/registration/segments.h"
#include "sim/registration/starts.h"

namespace hydroprint::registration {
namespace {

constexpr double kJump_mm = 12;
/// Limits for the size of a cluster, relative to the board's diagonal.
constexpr double kLeastSize = 0.8, kMostSize = 1.2;
constexpr std::size_t kMostStarts = 6;
/// Limits of PoseFit::paired_share / PoseFit::rms_sigmas.
constexpr double kLeastPaired = 0.6, kSurely = 0.85;
constexpr double kStartReach_mm = 25, kLeastFacing = 0.2;
constexpr std::size_t kFewestViews = 5;
constexpr int kCell_px = 80;
constexpr double kLeastCovered = 0.6;
constexpr double kLeastTilt_rad = 25 * std::numbers::pi / 180;
constexpr double kLeastRange = 0.15;

double across(const scan::Cloud& cloud, const std::vector<int>& piece) {
  // The distance between the two extreme points, maximised over several directions.
  double most = 0;
  constexpr int kDirections = 24;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = std::numbers::pi * i / kDirections;
    const Eigen::Vector3d along(std::cos(angle), std::sin(angle), 0);
    const auto less = [&](int a, int b) {
      return cloud.points[static_cast<std::size_t>(a)].point_mm.dot(along) <
             cloud.points[static_cast<std::size_t>(b)].point_mm.dot(along);
    };
    const auto [low, high] = std::minmax_element(piece.begin(), piece.end(), less);
    most = std::max(most, (cloud.points[static_cast<std::size_t>(*low)].point_mm -
                           cloud.points[static_cast<std::size_t>(*high)].point_mm)
                              .norm());
  }
  return most;
}

/// Returns the pose in which the board faces the camera upright.
Pose facing() {
  Pose out = Pose::Identity();
  out.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  return out;
}

std::vector<scan::ScanPoint> one_a_patch(const scan::Cloud& cloud, const std::vector<int>& piece,
                                         int patch_px) {
  std::vector<scan::ScanPoint> out;
  for (const int i : piece) {
    const auto& p = cloud.points[static_cast<std::size_t>(i)];
    if (p.u % patch_px == patch_px / 2 && p.v % patch_px == patch_px / 2) out.push_back(p);
  }
  return out;
}

/// Returns the two poses that the board's bend allows. Its plates slope away from its ridge, so
/// normals vary most across the ridge, which determines the orientation up to half a turn.
std::array<Pose, 2> by_its_bend(const std::vector<scan::ScanPoint>& points, const Shape& board) {
  // Points are weighted by their area on the board, not in the image.
  double area = 0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), mean = middle;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const scan::ScanPoint& p : points) {
    const double facing = -p.normal.dot(p.point_mm.normalized());
    const double own = p.point_mm.z() * p.point_mm.z() / std::max(kLeastFacing, facing);
    area += own;
    middle += own * p.point_mm;
    mean += own * p.normal;
    squares += own * p.normal * p.normal.transpose();
  }
  middle /= area;
  mean /= area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> bend(squares / area -
                                                            mean * mean.transpose());
  const Eigen::Vector3d up = mean.normalized(), most = bend.eigenvectors().col(2);
  const Eigen::Vector3d across = (most - most.dot(up) * up).normalized();
  std::array<Pose, 2> out;
  for (const int i : {0, 1}) {
    Pose& X_CB = out[static_cast<std::size_t>(i)];
    X_CB = Pose::Identity();
    X_CB.linear().col(0) = i == 0 ? across : Eigen::Vector3d(-across);
    X_CB.linear().col(1) = up.cross(X_CB.linear().col(0));
    X_CB.linear().col(2) = up;
    X_CB.translation() = middle - X_CB.linear() * board.centroid();
  }
  return out;
}

}  // namespace

Result<std::optional<BoardView>> find_board(const scan::Cloud& cloud, const Shape& board,
                                            int patch_px, const Context& context) {
  const std::vector<bool> all(cloud.points.size(), true);
  FitOptions options;
  options.weak_sigma_mm = 1e3;
  options.reach_mm = kStartReach_mm;
  std::optional<BoardView> best;
  double most = kLeastPaired;
  for (const auto& piece : segments(cloud, all, kJump_mm)) {
    const double size = across(cloud, piece) / board.diagonal_mm();
    if (size < kLeastSize || size > kMostSize) continue;
    BoardView view{one_a_patch(cloud, piece, patch_px), {}};
    const auto try_from = [&](const Pose& start) {
      const auto fit = fit_pose(board, view.points, cloud.camera, start, start, options, context);
      if (!fit || fit->paired_share / fit->rms_sigmas <= most) return;
      most = fit->paired_share / fit->rms_sigmas;
      view.X_CB = fit->X_CB;
      best = view;
    };
    for (const Pose& start : by_its_bend(view.points, board)) try_from(start);
    if (best) break;
    HP_ASSIGN_OR_RETURN(const auto starts,
                        rough_alignments(board, view.points, facing(), kMostStarts, context));
    for (const Pose& start : starts) {
      try_from(start);
      if (most > kSurely) break;
    }
  }
  return best;
}

std::string lacking(const std::vector<BoardView>& views, const scan::Lens& lens) {
  if (views.size() < kFewestViews)
    return fmt::format(
        "the board was found in only {} views. Record at least five views, with the whole board in "
        "view and clear of the background",
        views.size());
  std::set<int> cells;
  double tilt = 0, nearest = 1e9, farthest = 0;
  for (const BoardView& a : views) {
    for (const auto& p : a.points) cells.insert(p.v / kCell_px * 1000 + p.u / kCell_px);
    nearest = std::min(nearest, a.X_CB.translation().z());
    farthest = std::max(farthest, a.X_CB.translation().z());
    for (const BoardView& b : views)
      tilt = std::max(tilt, std::acos(std::clamp(a.X_CB.linear().col(2).dot(b.X_CB.linear().col(2)),
                                                 -1.0, 1.0)));
  }
  const int all = (lens.width_px / kCell_px) * (lens.height_px / kCell_px);
  if (static_cast<double>(cells.size()) < kLeastCovered * all)
    return "the board covers too little of the image. Also record it in the corners of the image";
  if (tilt < kLeastTilt_rad)
    return "the board has about the same tilt in all views. Tilt it by 30 degrees in each "
           "direction";
  if (farthest - nearest < kLeastRange * nearest)
    return "the board is at about the same distance in all views. Record some views nearer and "
           "some farther";
  return {};
}

}  // namespace hydroprint::registration
