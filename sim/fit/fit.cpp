#include "sim/fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/base/check.h"
#include "sim/fit/predictor.h"
#include "sim/fit/selection.h"

namespace hydroprint::fit {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;
using Places = std::vector<Vector2d>;

/// Error of a prediction that varies from dip to dip, for example because sweeps end earlier or
/// later.
constexpr double kFloor_mm = 0.003;
/// Tolerance of the sheet's sweeps. It is small because derivatives are differences of predictions.
constexpr double kSheetTolerance_mm = 3e-4;
/// Factor for mesh size and step of the finer computation, from which the discretisation error is
/// estimated.
constexpr double kFineFactor = 0.6;
/// The error grows with the square of mesh size and step. Of the difference between the usual and
/// the finer result, this fraction remains as the error of the finer one.
constexpr double kErrorLeft = kFineFactor * kFineFactor / (1 - kFineFactor * kFineFactor);
constexpr double kFineDipCost = 4;
constexpr int kMostOutlierRounds = 3;

Domain domain_of(const std::vector<Parameter>& free, const film::Profile& start) {
  const auto count = static_cast<Index>(free.size());
  Domain domain{VectorXd(count), VectorXd(count), VectorXd(count)};
  for (Index j = 0; j < count; ++j) {
    const Description what = describe(free[j], start);
    domain.low[j] = what.least;
    domain.high[j] = what.most;
    domain.step[j] = what.step;
  }
  return domain;
}

VectorXd scaled_values(const std::vector<Parameter>& free, const film::Profile& profile) {
  VectorXd u(static_cast<Index>(free.size()));
  for (Index j = 0; j < u.size(); ++j) u[j] = scaled_value(free[j], profile);
  return u;
}

film::Profile profile_of(const std::vector<Parameter>& free, const VectorXd& u,
                         film::Profile profile) {
  HP_CHECK(u.size() == static_cast<Index>(free.size()));
  for (Index j = 0; j < u.size(); ++j) set_scaled(free[j], u[j], profile);
  return profile;
}

pipeline::DipOptions accurate(pipeline::DipOptions options) {
  options.sheet.tolerance_mm = kSheetTolerance_mm;
  options.sheet.most_sweeps += 2;
  return options;
}

/// One fit in progress.
class Fitting {
 public:
  Fitting(const mesh::Model& model, const pipeline::DipOptions& dip, const Options& options,
          const Context& context)
      : model_(model),
        dip_(accurate(dip)),
        options_(options),
        context_(context),
        quiet_{context.threads, {}, context.cancelled},
        predictor_(model, dip_),
        free_(options.free) {}

  Result<Outcome> run(const std::vector<Point>& points) {
    out_.undetermined = never_determined();
    HP_RETURN_IF_ERROR(select(points));
    hold_ink_without_ink();
    u_ = scaled_values(free_, dip_.profile);
    for (int round = 0;; ++round) {
      HP_RETURN_IF_ERROR(minimise_what_is_known());
      HP_RETURN_IF_ERROR(refine());
      const int outliers = mark_outliers(out_.points, kFloor_mm);
      if (!options_.drop_outliers || outliers == 0 || round == kMostOutlierRounds) break;
      for (PointResult& p : out_.points) {
        if (p.is_used() && p.is_outlier) {
          p.left_out = "an outlier: the residual exceeds 4 robust standard deviations";
        }
      }
      HP_RETURN_IF_ERROR(check_enough(out_.points, options_.points_name));
    }
    conclude();
    return std::move(out_);
  }

 private:
  /// Finds the points on the surface and decides which are used.
  Status select(const std::vector<Point>& points) {
    HP_ASSIGN_OR_RETURN(const pipeline::StokesPass* begun,
                        predictor_.start(dip_.profile.swelling, quiet_));
    out_.X_FO = begun->X_FO;
    out_.warnings = model_.warnings;
    const Warnings& more = begun->surface.warnings;
    out_.warnings.insert(out_.warnings.end(), more.begin(), more.end());
    std::vector<Eigen::Vector3d> places;
    for (const Point& point : points) places.push_back(point.surface_mm);
    HP_ASSIGN_OR_RETURN(spots_, nearest_spots(begun->surface, places, quiet_));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector2d none = Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
      out_.points.push_back({points[i], none, none,
                             geometric_objection(points[i], spots_[i], begun->body, dip_.outline),
                             false});
    }
    HP_ASSIGN_OR_RETURN(const Places before, predict(predictor_, dip_.profile, 1));
    for (std::size_t i = 0; i < points.size(); ++i) {
      PointResult& p = out_.points[i];
      p.before_mm = p.after_mm = before[i];
      if (p.is_used() && !before[i].allFinite()) {
        p.left_out = "no film reaches the measured point with the starting profile";
      }
    }
    return check_enough(out_.points, options_.points_name);
  }

  void hold_ink_without_ink() {
    const auto ink = std::find(free_.begin(), free_.end(), Parameter::kInkRatio);
    if (ink == free_.end() || dip_.ink.total_mm2() > 0) return;
    out_.undetermined.push_back(
        {"ink_ratio_mm",
         "without ink, no landing point depends on this parameter. Name the printed image"});
    free_.erase(ink);
  }

  Result<Places> predict(Predictor& predictor, const film::Profile& profile, double weight) {
    // The expected number of dips: about three rounds of derivatives, and the finer dips.
    const double expected = 7.0 * static_cast<double>(options_.free.size()) + 2 * kFineDipCost;
    context_.progress("fit", std::min(0.99, work_ / expected));
    work_ += weight;
    ++out_.dips;
    return predictor.predict(profile, spots_, quiet_);
  }

  /// Returns predicted minus measured printed positions, mm; NaN for points that are not used.
  [[nodiscard]] VectorXd residuals_of(const Places& predicted) const {
    VectorXd r(2 * static_cast<Index>(spots_.size()));
    for (std::size_t i = 0; i < spots_.size(); ++i) {
      const PointResult& p = out_.points[i];
      const auto at = static_cast<Index>(2 * i);
      r.segment<2>(at) = predicted[i] - p.point.film_mm;
      if (!p.is_used()) r.segment<2>(at).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    return r;
  }

  Status minimise_what_is_known() {
    while (!free_.empty()) {
      const Residuals residuals = [&](const VectorXd& u) -> Result<VectorXd> {
        HP_ASSIGN_OR_RETURN(const Places predicted,
                            predict(predictor_, profile_of(free_, u, dip_.profile), 1));
        return residuals_of(predicted);
      };
      const Domain domain = domain_of(free_, dip_.profile);
      HP_ASSIGN_OR_RETURN(Minimum minimum, minimise(residuals, u_, domain, kFloor_mm));
      out_.iterations += minimum.iterations;
      out_.settled = minimum.settled;
      u_ = minimum.u;
      at_ = std::move(minimum.at);
      const Linearised known = at_.of_known();
      const double t = student_t(0.5 + 0.5 * kConfidence, degrees_of_freedom(known));
      const std::vector<Unknown> held = unknowns(known, kFloor_mm, t);
      if (held.empty()) break;
      hold(held, std::sqrt(2 * mean_square(known.residuals)));
    }
    return {};
  }

  /// Holds these parameters at their starting values.
  void hold(const std::vector<Unknown>& held, double residual_mm) {
    for (const Unknown& unknown : held) {
      out_.undetermined.push_back(explain(unknown, free_, dip_.profile, residual_mm));
    }
    std::vector<Parameter> free;
    std::vector<double> values;
    for (Index j = 0; j < u_.size(); ++j) {
      const bool is_held =
          std::any_of(held.begin(), held.end(), [&](const Unknown& k) { return k.parameter == j; });
      if (is_held) continue;
      free.push_back(free_[j]);
      values.push_back(u_[j]);
    }
    free_ = std::move(free);
    u_ = Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
  }

  /// Makes a last step with a finer computation, whose error is smaller and can be estimated.
  Status refine() {
    discretisation_ = VectorXd::Zero(u_.size());
    motion_warnings_ = predictor_.warnings();
    if (free_.empty()) return {};
    Predictor fine(model_, pipeline::scaled_resolution(dip_, kFineFactor));
    const auto fine_residuals = [&](Places& predicted) -> Result<VectorXd> {
      HP_ASSIGN_OR_RETURN(predicted,
                          predict(fine, profile_of(free_, u_, dip_.profile), kFineDipCost));
      return residuals_of(predicted);
    };
    Places after;
    HP_ASSIGN_OR_RETURN(VectorXd there, fine_residuals(after));
    const Linearised usual = at_;
    at_.residuals = there;
    // Uses only points that are known in both computations.
    const Linearised difference = Linearised{there - usual.residuals, usual.jacobian}.of_known();
    discretisation_ = kErrorLeft * (gain(difference.jacobian) * difference.residuals).cwiseAbs();
    out_.discretisation_mm = std::sqrt(2 * mean_square(difference.residuals));
    u_ += bounded_step(at_.of_known(), u_, domain_of(free_, dip_.profile), 0, 1);
    HP_ASSIGN_OR_RETURN(at_.residuals, fine_residuals(after));
    motion_warnings_ = fine.warnings();
    for (std::size_t i = 0; i < after.size(); ++i) {
      PointResult& p = out_.points[i];
      p.after_mm = after[i];
      const bool is_known =
          at_.jacobian.middleRows(static_cast<Index>(2 * i), 2).allFinite() && after[i].allFinite();
      if (p.is_used() && !is_known) {
        p.left_out =
            "film reaches the measured point only with some of the profiles that were tried";
      }
    }
    return {};
  }

  void conclude() {
    out_.profile = profile_of(free_, u_, dip_.profile);
    double before = 0, after = 0;
    int used = 0;
    for (const PointResult& p : out_.points) {
      if (!p.is_used()) continue;
      before += (p.before_mm - p.point.film_mm).squaredNorm();
      after += (p.after_mm - p.point.film_mm).squaredNorm();
      ++used;
    }
    out_.rms_before_mm = std::sqrt(before / used);
    out_.rms_after_mm = std::sqrt(after / used);
    out_.degrees_of_freedom = std::max(1, 2 * used - static_cast<int>(free_.size()));
    out_.residual_sigma_mm = std::sqrt(after / out_.degrees_of_freedom);
    out_.t_quantile = student_t(0.5 + 0.5 * kConfidence, out_.degrees_of_freedom);
    out_.warnings.insert(out_.warnings.end(), motion_warnings_.begin(), motion_warnings_.end());
    if (free_.empty()) {
      out_.warnings.push_back({WarningCode::NOTHING_DETERMINED,
                               "the points determine none of the parameters; the profile "
                               "stays unchanged",
                               {InFile{options_.points_name}}});
      return;
    }
    const Linearised known = at_.of_known();
    out_.estimates = estimates_of(free_, dip_.profile, u_, domain_of(free_, dip_.profile), known,
                                  kFloor_mm, discretisation_);
    out_.correlation = correlation_of(jackknife_covariance(known, kFloor_mm));
    warn();
  }

  void warn() {
    const auto outliers = std::count_if(out_.points.begin(), out_.points.end(),
                                        [](const auto& p) { return p.is_used() && p.is_outlier; });
    if (outliers > 0) {
      out_.warnings.push_back({WarningCode::OUTLIERS,
                               fmt::format("{} points have residuals above 4 robust "
                                           "standard deviations but are still used; "
                                           "see residuals.csv, or leave the outliers out",
                                           outliers),
                               {InFile{options_.points_name}}});
    }
    if (!out_.settled) {
      out_.warnings.push_back({WarningCode::FIT_NOT_SETTLED,
                               "the fit stopped before it converged; start from another "
                               "profile",
                               {InFile{options_.points_name}}});
    }
  }

  const mesh::Model& model_;
  pipeline::DipOptions dip_;
  const Options& options_;
  const Context& context_;
  Context quiet_;
  Predictor predictor_;
  std::vector<Parameter> free_;
  VectorXd u_;               ///< scaled values of free_
  Linearised at_;            ///< linearisation at u_
  VectorXd discretisation_;  ///< standard errors of u_ due to discretisation
  std::vector<Spot> spots_;
  Warnings motion_warnings_;  ///< warnings of the last prediction
  double work_ = 0;           ///< work done, in dips; a finer dip counts as kFineDipCost
  Outcome out_;
};

}  // namespace

Result<Outcome> fit(const mesh::Model& model, const pipeline::DipOptions& dip,
                    const std::vector<Point>& points, const Options& options,
                    const Context& context) {
  return Fitting(model, dip, options, context).run(points);
}

}  // namespace hydroprint::fit
