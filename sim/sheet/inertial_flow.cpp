#include "sim/sheet/inertial_flow.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/check.h"
#include "sim/sheet/dip_parts.h"
#include "sim/sheet/sheet_step.h"
#include "sim/velocity/quadratic_elements.h"

namespace hydroprint::sheet {
namespace {

using Eigen::Vector2d;
using velocity::VelocityField;
using Velocities = std::vector<Vector2d>;

constexpr double kLeastSpan_mm = 1e-6;
/// Maximum number of times that steps are shortened to a quarter.
constexpr int kMostShortened = 6;

Velocities scaled(Velocities velocities, double by) {
  for (Vector2d& u : velocities) u *= by;
  return velocities;
}

/// Returns the velocity, in mm/s, that the film at the nodes of waterline `k` had at the previous
/// waterline. If there was no film nearby, uses the current velocity.
Velocities velocity_before(const flow::DipField& dip, std::size_t k, double speed_mm_per_s) {
  HP_CHECK(k < dip.fields.size());
  const VelocityField& now = dip.fields[k];
  Velocities before(now.nodes().size(), Vector2d::Zero());  // before first contact
  if (k == 0) return before;
  const double span_mm = dip.immersion_mm[k] - dip.immersion_mm[k - 1];
  for (std::size_t n = 0; n < before.size(); ++n) {
    const Vector2d place = velocity::place_of(now.mesh(), n) - span_mm * now.nodes()[n];
    Vector2d u = now.nodes()[n];
    if (Vector2d found; dip.fields[k - 1].nearest(place, found) < VelocityField::kNoFilm_mm) {
      u = found;
    }
    before[n] = speed_mm_per_s * u;
  }
  return before;
}

/// Computes the last of `steps` steps at waterline `k`. The velocities at the previous waterlines
/// must be known.
Result<Velocities> last_step(const flow::DipField& dip, std::size_t k, double steps,
                             const std::vector<double>& thickness_mm,
                             const InertialOptions& options) {
  const double speed = options.dip_speed_mm_per_s;
  const double step_s = std::max(span_mm(dip, k), kLeastSpan_mm) / steps / speed;
  velocity::StepFilm film;
  film.elasticity = options.elasticity;
  film.elasticity.young_modulus_mpa *= kYoungsModulusStep_s / step_s;
  // The steps change the velocity evenly, so the last one accounts for 1 / steps of the change.
  film.density_kg_per_m3 = options.density_kg_per_m3 / steps;
  const double viscosity_mpa_s = options.elasticity.young_modulus_mpa * kYoungsModulusStep_s / 3;
  film.drag_mpa_s_per_mm = viscosity_mpa_s * options.drag_per_mm;
  HP_ASSIGN_OR_RETURN(Velocities out,
                      velocity::sheet_step(dip.fields[k].mesh(), thickness_mm, film, step_s,
                                           velocity_before(dip, k, speed),
                                           scaled(prescribed(dip.fields[k]), speed)));
  return scaled(std::move(out), 1 / speed);
}

/// Computes the velocities at waterline `k` from those at the previous waterlines and an initial
/// guess at `k`. Steps are shortened if they do not converge, for example where film is drawn
/// through narrow gaps.
Result<Velocities> step(const flow::DipField& dip, std::size_t k,
                        const std::vector<double>& thickness_mm, const InertialOptions& options) {
  HP_CHECK(options.step_mm > 0);
  double steps = std::ceil(std::max(span_mm(dip, k), kLeastSpan_mm) / options.step_mm);
  for (int shortened = 0;; ++shortened) {
    auto out = last_step(dip, k, steps, thickness_mm, options);
    if (out || shortened == kMostShortened) return out;
    steps *= 4;
  }
}

}  // namespace

Result<flow::DipField> inertial_flow(flow::DipField first, const RestThickness& rest_thickness,
                                     const InertialOptions& options, const Context& context) {
  HP_CHECK(first.immersion_mm.size() == first.fields.size());
  HP_CHECK(options.most_passes >= 1);
  flow::DipField dip = std::move(first);
  const std::size_t count = dip.fields.size();
  dip.is_torn.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    for (int pass = 1; pass <= options.most_passes; ++pass) {
      HP_RETURN_IF_ERROR(check_cancelled(context));
      FloatingFilm film = floating_film(dip, k, rest_thickness, options.tear_stretch);
      HP_ASSIGN_OR_RETURN(Velocities nodes, step(dip, k, film.thickness_mm, options));
      dip.is_torn[k] = std::move(film.is_torn);
      const double move_mm = span_mm(dip, k) * rms_change(nodes, dip.fields[k].nodes());
      dip.fields[k] = dip.fields[k].with(std::move(nodes));
      if (move_mm < options.tolerance_mm) break;
    }
    context.progress("sheet", static_cast<double>(k + 1) / static_cast<double>(count));
  }
  return dip;
}

}  // namespace hydroprint::sheet
