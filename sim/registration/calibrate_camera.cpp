#include "sim/registration/calibrate_camera.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

#include "sim/registration/board_views.h"
#include "sim/registration/pairs.h"
#include "sim/registration/robust.h"

namespace hydroprint::registration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using scan::Lens;

constexpr int kLens = Lens::kParameters;
constexpr int kMostIterations = 25;
constexpr double kFirstReachMm = 12, kLeastReachMm = 6, kReachShrinks = 0.8;
constexpr double kSettled = 1e-4;  ///< of what was believed
constexpr double kMostSigmas = 2;
constexpr double kToldShare = 1.0 / 3;
constexpr std::array kNames{"focal length across", "focal length down", "image centre across",
                            "image centre down",   "distortion k1",     "distortion k2",
                            "distortion p1",       "distortion p2",     "depth scale"};

tl::unexpected<Error> poor(const std::string& why) {
  return fail(Code::kFailedPrecondition, "the views do not calibrate the camera: " + why,
              "POOR_VIEWS");
}

Lens::Vector believed(const Lens& nominal) {
  Lens::Vector out;
  out << 0.1 * nominal.fx_px, 0.1 * nominal.fy_px, 15, 15, 0.3, 1, 0.01, 0.01, 0.05;
  return out;
}

/// How a residual goes with the lens's parameters, in units of what was believed, and with the
/// pose of its view.
using Row = Eigen::Matrix<double, kLens + 6, 1>;

/// Least squares over the lens and the board's pose in each view.
struct System {
  explicit System(std::size_t views)
      : matrix(MatrixXd::Zero(kLens + 6 * static_cast<Index>(views),
                              kLens + 6 * static_cast<Index>(views))),
        right(VectorXd::Zero(matrix.rows())) {}

  static Index place_of(std::size_t view) { return kLens + 6 * static_cast<Index>(view); }

  void add(std::size_t view, const Row& row, double weight, double residual) {
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
  Adjuster(std::vector<BoardView> views, const Shape& board, const Lens& nominal,
           const Context& context)
      : views_(std::move(views)),
        board_(board),
        nominal_(nominal),
        lens_(nominal),
        believed_(believed(nominal)),
        context_(context) {}

  Result<CameraCalibration> adjust() {
    double reach = kFirstReachMm;
    for (int i = 0; i < kMostIterations; ++i) {
      HP_RETURN_IF_ERROR(check_cancelled(context_));
      context_.progress("adjusting", static_cast<double>(i) / kMostIterations);
      HP_RETURN_IF_ERROR(look(reach));
      const System system = build();
      const VectorXd step = system.matrix.ldlt().solve(system.right);
      take(step);
      const bool at_reach = reach <= kLeastReachMm;
      reach = std::max(kLeastReachMm, kReachShrinks * reach);
      if (at_reach && step.head<kLens>().norm() < kSettled) break;
    }
    HP_RETURN_IF_ERROR(look(reach));
    return told();
  }

 private:
  /// The points of one view on the board, as lens and pose are believed now.
  struct Look {
    std::vector<Pair> pairs;
    std::vector<double> weights;  ///< robust ones over variance
    double spread = 1;
  };

  Status look(double reach) {
    const Pairing pairing = reach > kLeastReachMm ? Pairing::kNearest : Pairing::kOnRay;
    looks_.clear();
    for (BoardView& view : views_) {
      for (auto& p : view.points) p.point_mm = lens_.point(p.u, p.v, p.reported_mm);
      Look out;
      HP_ASSIGN_OR_RETURN(out.pairs,
                          pair_up(board_, view.points, view.X_CB, pairing, reach, context_));
      std::vector<double> off;
      for (const Pair& pair : out.pairs) off.push_back(pair.residual_mm / pair.sigma_mm());
      out.spread = spread_of(off);
      for (std::size_t i = 0; i < off.size(); ++i)
        out.weights.push_back(robust_weight(off[i], out.spread) /
                              std::pow(out.pairs[i].sigma_mm(), 2));
      looks_.push_back(std::move(out));
    }
    return {};
  }

  /// Where the board is, not where the scan has it: noise in the rows would go with that in the
  /// residuals, and pull relief flat, by its variance over that of the relief (3 %).
  [[nodiscard]] Row row_of(std::size_t view, const Pair& pair) const {
    const double reported_mm = pair.on_mm.z() / lens_.depth_scale;
    Row out;
    out << (pair.normal.transpose() * lens_.derivatives(pair.scan->u, pair.scan->v, reported_mm))
               .transpose()
               .cwiseProduct(believed_),
        -direction(pair, views_[view].X_CB.translation(), 1);
    return out;
  }

  /// Calls `use` with the view, the pair, its weight and its row.
  template <class Use>
  void for_each_pair(Use use) const {
    for (std::size_t k = 0; k < looks_.size(); ++k)
      for (std::size_t i = 0; i < looks_[k].pairs.size(); ++i)
        if (looks_[k].weights[i] > 0)
          use(k, looks_[k].pairs[i], looks_[k].weights[i], row_of(k, looks_[k].pairs[i]));
  }

  [[nodiscard]] System build() const {
    System out(views_.size());
    out.matrix.topLeftCorner<kLens, kLens>().setIdentity();  // what was believed
    out.right.head<kLens>() = (nominal_.parameters() - lens_.parameters()).cwiseQuotient(believed_);
    for_each_pair([&](std::size_t view, const Pair& pair, double weight, const Row& row) {
      out.add(view, row, weight, pair.residual_mm);
    });
    return out;
  }

  /// Covariance of the right side by noise: what does not change with time is the same for a patch
  /// in every view.
  [[nodiscard]] MatrixXd scatter() const {
    System changing(views_.size());
    changing.matrix.topLeftCorner<kLens, kLens>().setIdentity();
    std::unordered_map<int, VectorXd> patches;
    for_each_pair([&](std::size_t view, const Pair& pair, double weight, const Row& row) {
      const double pull = weight * looks_[view].spread;
      changing.add(view, row, std::pow(pull * pair.changing_sigma_mm, 2), 0);
      VectorXd& sum = patches.try_emplace(pair.scan->patch, VectorXd::Zero(changing.right.size()))
                          .first->second;
      sum.head<kLens>() += pull * pair.constant_sigma_mm * row.head<kLens>();
      sum.segment<6>(System::place_of(view)) += pull * pair.constant_sigma_mm * row.tail<6>();
    });
    MatrixXd out = std::move(changing.matrix);
    for (const auto& [patch, sum] : patches) out.noalias() += sum * sum.transpose();
    return out;
  }

  void take(const VectorXd& step) {
    lens_ = lens_.with(lens_.parameters() + step.head<kLens>().cwiseProduct(believed_));
    for (std::size_t k = 0; k < views_.size(); ++k) {
      const Vector6 twist = step.segment<6>(System::place_of(k));
      views_[k].X_CB = motion(twist, views_[k].X_CB.translation()) * views_[k].X_CB;
    }
  }

  [[nodiscard]] Result<CameraCalibration> told() const {
    const System system = build();
    const MatrixXd gain =
        system.matrix.ldlt().solve(MatrixXd::Identity(system.matrix.rows(), system.matrix.cols()));
    const MatrixXd covariance = gain * scatter() * gain;
    const Lens::Matrix scaled = covariance.topLeftCorner<kLens, kLens>();
    CameraCalibration out;
    out.lens = lens_;
    out.covariance = believed_.asDiagonal() * scaled * believed_.asDiagonal();
    out.views = views_.size();
    judge(out);
    if (out.rms_sigmas > kMostSigmas)
      return poor(
          "the board does not have its shape in them; is it the right board, standing still?");
    for (std::size_t j = 0; j < kLens; ++j) {
      const auto i = static_cast<Index>(j);
      if (std::sqrt(scaled(i, i)) > kToldShare)
        return poor(std::string("they do not tell the ") + kNames[j] +
                    ": take more, nearer, and tilted more");
    }
    return out;
  }

  void judge(CameraCalibration& out) const {
    double squares_mm = 0, squares = 0, count = 0;
    for (const Look& look : looks_) {
      for (std::size_t i = 0; i < look.pairs.size(); ++i) {
        if (look.weights[i] == 0) continue;
        squares_mm += std::pow(look.pairs[i].residual_mm, 2);
        squares += std::pow(look.pairs[i].residual_mm / look.pairs[i].sigma_mm(), 2);
        ++count;
      }
    }
    out.rms_mm = std::sqrt(squares_mm / std::max(1.0, count));
    out.rms_sigmas = std::sqrt(squares / std::max(1.0, count));
  }

  std::vector<BoardView> views_;
  std::vector<Look> looks_;  ///< one a view; refer to its points
  const Shape& board_;
  const Lens& nominal_;
  Lens lens_;
  Lens::Vector believed_;
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
    HP_ASSIGN_OR_RETURN(const auto cloud, scan::make_cloud(views[k], nominal, noise, context));
    HP_ASSIGN_OR_RETURN(auto view, find_board(cloud, shape, noise.patch_px, context));
    if (view) found.push_back(std::move(*view));
  }
  if (const std::string what = lacking(found, nominal); !what.empty()) return poor(what);
  return Adjuster(std::move(found), shape, nominal, context).adjust();
}

}  // namespace hydroprint::registration
