#include "sim/registration/camera/learn_pattern.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <utility>

namespace hydroprint::registration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kLens = scan::Lens::kParameters;
/// Maximum number of unknowns besides the lens's: those of twelve views.
constexpr Index kMostOthers = 72;

/// Reduces the number of unknowns: keeps those of the lens, and the strongest combinations of the
/// others, which are also independent of each other. The rest is added to each patch's own error.
MatrixXd strongest(const MatrixXd& shared, std::vector<float>& sigma) {
  const Index others = shared.rows() - kLens;
  if (others <= kMostOthers) return shared;
  const MatrixXd all = shared.bottomRows(others);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> axes(all * all.transpose());
  const MatrixXd kept = axes.eigenvectors().rightCols(kMostOthers).transpose() * all;
  for (Index i = 0; i < all.cols(); ++i) {
    float& own = sigma[static_cast<std::size_t>(i)];
    const double rest = all.col(i).squaredNorm() - kept.col(i).squaredNorm();
    own = static_cast<float>(std::sqrt(own * own + std::max(0.0, rest)));
  }
  MatrixXd out(kLens + kMostOthers, shared.cols());
  out << shared.topRows(kLens), kept;
  return out;
}

}  // namespace

scan::FixedPattern learn_pattern(const std::vector<Sighting>& sightings,
                                 const std::function<SightingRow(const Sighting&)>& row_of,
                                 const MatrixXd& covariance, double spread,
                                 scan::FixedPattern empty) {
  scan::FixedPattern out = std::move(empty);
  const auto patches = static_cast<Index>(out.patches());
  out.offset.assign(out.patches(), 0);
  out.sigma.assign(out.patches(), 1);
  MatrixXd by_unknowns = MatrixXd::Zero(covariance.rows(), patches);
  for_each_patch(sightings, [&](std::span<const Sighting> patch) {
    const Constant constant = constant_of(patch);
    const int place = patch.front().pair.scan->patch;
    // A depth that is too large moves the point inward, where residuals are negative.
    const auto i = static_cast<std::size_t>(place);
    out.offset[i] = static_cast<float>(-constant.pull / constant.square);
    out.sigma[i] = static_cast<float>(std::min(1.0, spread / std::sqrt(constant.square)));
    for (const Sighting& s : patch)
      add_row(by_unknowns.col(place), s.view, row_of(s),
              -s.weight() * s.pair.constant_sigma_mm / constant.square);
  });
  const MatrixXd root = covariance.llt().matrixL();
  out.set_shared(strongest(root.transpose() * by_unknowns, out.sigma));
  return out;
}

}  // namespace hydroprint::registration
