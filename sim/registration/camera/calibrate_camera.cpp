#include "sim/registration/camera/calibrate_camera.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "sim/registration/camera/board_views.h"
#include "sim/registration/camera/learn_pattern.h"
#include "sim/registration/camera/sightings.h"
#include "sim/registration/robust.h"

namespace hydroprint::registration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using scan::Lens;

constexpr int kLens = Lens::kParameters;
constexpr int kMostIterations = 25;
constexpr double kFirstReach_mm = 12, kLeastReach_mm = 6, kReachShrinks = 0.8;
/// A smaller step ends the iteration; in standard deviations of the prior.
constexpr double kSettled = 1e-4;
constexpr double kMostSigmas = 2;
constexpr double kDeterminedShare = 1.0 / 3;
constexpr std::array kNames{
    "horizontal focal length", "vertical focal length", "horizontal image centre",
    "vertical image centre",   "distortion k1",         "distortion k2",
    "distortion p1",           "distortion p2",         "depth scale"};

tl::unexpected<Error> poor(const std::string& why) {
  return fail(Code::kFailedPrecondition, "the camera cannot be calibrated from these views: " + why,
              ErrorReason::POOR_VIEWS);
}

Lens::Vector prior_sigma(const Lens& nominal) {
  Lens::Vector out;
  out << 0.1 * nominal.fx_px, 0.1 * nominal.fy_px, 15, 15, 0.3, 1, 0.01, 0.01, 0.05;
  return out;
}

/// Least squares over the lens and the board's pose in each view.
struct System {
  explicit System(std::size_t views)
      : matrix(MatrixXd::Zero(kLens + 6 * static_cast<Index>(views),
                              kLens + 6 * static_cast<Index>(views))),
        right(VectorXd::Zero(matrix.rows())) {}

  void add(std::size_t view, const SightingRow& row, double weight, double residual) {
    const Index at = place_of(view);
    const auto lens = row.head<kLens>();
    const auto pose = row.tail<6>();
    matrix.topLeftCorner<kLens, kLens>() += weight * lens * lens.transpose();
    matrix.block<kLens, 6>(0, at) += weight * lens * pose.transpose();
    matrix.block<6, kLens>(at, 0) += weight * pose * lens.transpose();
    matrix.block<6, 6>(at, at) += weight * pose * pose.transpose();
    right.head<kLens>() -= weight * residual * lens;
    right.segment<6>(at) -= weight * residual * pose;
  }

  MatrixXd matrix;
  VectorXd right;
};

class Adjuster {
 public:
  Adjuster(std::vector<BoardView> views, const Shape& board, const Lens& nominal, int patch_px,
           const Context& context)
      : views_(std::move(views)),
        board_(board),
        nominal_(nominal),
        patch_px_(patch_px),
        lens_(nominal),
        prior_sigma_(prior_sigma(nominal)),
        context_(context) {}

  Result<CameraCalibration> adjust() {
    double reach = kFirstReach_mm;
    for (int i = 0; i < kMostIterations; ++i) {
      HP_RETURN_IF_ERROR(check_cancelled(context_));
      context_.progress("adjusting", static_cast<double>(i) / kMostIterations);
      HP_RETURN_IF_ERROR(look(reach));
      const System system = build();
      const VectorXd step = system.matrix.ldlt().solve(system.right);
      take(step);
      const bool at_reach = reach <= kLeastReach_mm;
      reach = std::max(kLeastReach_mm, kReachShrinks * reach);
      if (at_reach && step.head<kLens>().norm() < kSettled) break;
    }
    HP_RETURN_IF_ERROR(look(reach));
    return result();
  }

 private:
  Status look(double reach) {
    const Pairing pairing = reach > kLeastReach_mm ? Pairing::kNearest : Pairing::kOnRay;
    sightings_.clear();
    for (std::size_t k = 0; k < views_.size(); ++k) {
      BoardView& view = views_[k];
      for (auto& p : view.points) p.point_mm = lens_.point(p.u, p.v, p.reported_mm);
      HP_ASSIGN_OR_RETURN(const auto pairs,
                          pair_up(board_, view.points, view.X_CB, pairing, reach, context_));
      for (const Pair& pair : pairs) sightings_.push_back({k, pair});
    }
    const auto by_patch = [](const Sighting& a, const Sighting& b) {
      return a.pair.scan->patch < b.pair.scan->patch;
    };
    std::stable_sort(sightings_.begin(), sightings_.end(), by_patch);
    weigh();
    return {};
  }

  /// Returns the deviation of each sighting from the value predicted by the others of its patch, in
  /// standard deviations.
  [[nodiscard]] std::vector<double> sigmas_off() const {
    std::vector<double> out;
    out.reserve(sightings_.size());
    for_each_patch(sightings_, [&](std::span<const Sighting> patch) {
      const Constant all = constant_of(patch);
      for (const Sighting& s : patch) {
        Constant others = all;
        others.add(s, -1);
        const double constant = s.pair.constant_sigma_mm;
        out.push_back((s.pair.residual_mm - constant * others.pull / others.square) /
                      std::hypot(s.pair.own_sigma_mm(), constant / std::sqrt(others.square)));
      }
    });
    return out;
  }

  /// Downweights sightings with large residuals, then those that disagree with the others of their
  /// patch.
  void weigh() {
    std::vector<double> off;
    for (const Sighting& s : sightings_) off.push_back(s.pair.residual_mm / s.pair.sigma_mm());
    for (int round = 0; round < 2; ++round) {
      spread_ = spread_of(off);
      for (std::size_t i = 0; i < off.size(); ++i)
        sightings_[i].robust = robust_weight(off[i], spread_);
      if (round == 0) off = sigmas_off();
    }
  }

  /// The row is evaluated on the board, not at the scan point. Otherwise noise in the rows would
  /// correlate with noise in the residuals and flatten the relief by the ratio of their variances
  /// (3 %).
  [[nodiscard]] SightingRow row_of(const Sighting& s) const {
    const Pair& pair = s.pair;
    const double reported_mm = pair.on_mm.z() / lens_.depth_scale;
    SightingRow out;
    out << (pair.normal.transpose() * lens_.derivatives(pair.scan->u, pair.scan->v, reported_mm))
               .transpose()
               .cwiseProduct(prior_sigma_),
        -direction(pair, views_[s.view].X_CB.translation(), 1);
    return out;
  }

  /// Returns the normal equations, with each patch's constant noise eliminated. This noise is one
  /// more unknown for each patch, the same in every view, with mean 0 and a known standard
  /// deviation.
  [[nodiscard]] System build() const {
    System out(views_.size());
    out.matrix.topLeftCorner<kLens, kLens>().setIdentity();  // the prior
    out.right.head<kLens>() =
        (nominal_.parameters() - lens_.parameters()).cwiseQuotient(prior_sigma_);
    MatrixXd eliminated = MatrixXd::Zero(out.right.size(), static_cast<Index>(sightings_.size()));
    Index patches = 0;
    for_each_patch(sightings_, [&](std::span<const Sighting> patch) {
      const Constant constant = constant_of(patch);
      auto column = eliminated.col(patches++);
      for (const Sighting& s : patch) {
        if (s.robust == 0) continue;
        const SightingRow row = row_of(s);
        out.add(s.view, row, s.weight(), s.pair.residual_mm);
        add_row(column, s.view, row,
                s.weight() * s.pair.constant_sigma_mm / std::sqrt(constant.square));
      }
      out.right += column * (constant.pull / std::sqrt(constant.square));
    });
    const auto all = eliminated.leftCols(patches);
    out.matrix.noalias() -= all * all.transpose();
    return out;
  }

  void take(const VectorXd& step) {
    lens_ = lens_.with(lens_.parameters() + step.head<kLens>().cwiseProduct(prior_sigma_));
    for (std::size_t k = 0; k < views_.size(); ++k) {
      const Vector6 twist = step.segment<6>(place_of(k));
      views_[k].X_CB = motion(twist, views_[k].X_CB.translation()) * views_[k].X_CB;
    }
  }

  [[nodiscard]] Result<CameraCalibration> result() const {
    const System system = build();
    const MatrixXd all =
        spread_ * spread_ *
        system.matrix.ldlt().solve(MatrixXd::Identity(system.matrix.rows(), system.matrix.cols()));
    const Lens::Matrix scaled = all.topLeftCorner<kLens, kLens>();
    CameraCalibration out;
    out.lens = lens_;
    out.covariance = prior_sigma_.asDiagonal() * scaled * prior_sigma_.asDiagonal();
    out.views = views_.size();
    judge(out);
    if (out.rms_sigmas > kMostSigmas)
      return poor(
          "the board's shape does not match the views. Use the calibration board, and hold it "
          "still");
    for (std::size_t j = 0; j < kLens; ++j) {
      const auto i = static_cast<Index>(j);
      if (std::sqrt(scaled(i, i)) > kDeterminedShare)
        return poor(std::string("the views do not determine the ") + kNames[j] +
                    ". Record more views, nearer and with more tilt");
    }
    out.pattern = learn_pattern(sightings_, [this](const Sighting& s) { return row_of(s); }, all,
                                spread_, {lens_.width_px, lens_.height_px, patch_px_});
    return out;
  }

  void judge(CameraCalibration& out) const {
    double squares_mm = 0, squares = 0, count = 0;
    for (const Sighting& s : sightings_) {
      if (s.robust == 0) continue;
      squares_mm += std::pow(s.pair.residual_mm, 2);
      squares += std::pow(s.pair.residual_mm / s.pair.sigma_mm(), 2);
      ++count;
    }
    out.rms_mm = std::sqrt(squares_mm / std::max(1.0, count));
    out.rms_sigmas = std::sqrt(squares / std::max(1.0, count));
  }

  std::vector<BoardView> views_;
  std::vector<Sighting> sightings_;  ///< sorted by patch; they refer to the views' points
  double spread_ = 1;                ///< ratio of the residuals' spread to their noise
  const Shape& board_;
  const Lens& nominal_;
  int patch_px_;
  Lens lens_;
  Lens::Vector prior_sigma_;
  const Context& context_;
};

}  // namespace

Result<CameraCalibration> calibrate_camera(std::span<const scan::FusedFrame> views,
                                           const mesh::Surface& board, const scan::Lens& nominal,
                                           const scan::DepthNoise& noise, const Context& context) {
  const Shape shape(board);
  std::vector<BoardView> found;
  for (std::size_t k = 0; k < views.size(); ++k) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    context.progress("boards", static_cast<double>(k) / static_cast<double>(views.size()));
    HP_ASSIGN_OR_RETURN(const auto cloud, scan::make_cloud(views[k], {nominal}, noise, context));
    HP_ASSIGN_OR_RETURN(auto view, find_board(cloud, shape, noise.patch_px, context));
    if (view) found.push_back(std::move(*view));
  }
  if (const std::string what = lacking(found, nominal); !what.empty()) return poor(what);
  return Adjuster(std::move(found), shape, nominal, noise.patch_px, context).adjust();
}

}  // namespace hydroprint::registration
