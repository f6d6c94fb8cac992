#include "sim/flow/trace.h"

#include <algorithm>

namespace hydroprint::flow {
namespace {

/// Chords of the film mesh cut off this much of the film at most; farther outside is no film.
constexpr double kReach_mm = 0.15;
/// The predictor may overshoot the waterline; the corrector then needs some velocity all the same.
constexpr double kPredictorReach_mm = velocity::Locator::kReach_mm;

using Eigen::Vector2d;

/// One step of Heun's rule back to field `k` over `span_mm`; `velocity` is that at the start and
/// becomes that at the end.
bool step_back(const velocity::VelocityField& field, double span_mm, Vector2d& point,
               Vector2d& velocity) {
  Vector2d before;
  if (!field.at(point - span_mm * velocity, kPredictorReach_mm, before)) before = velocity;
  point -= 0.5 * span_mm * (velocity + before);
  return field.at(point, kReach_mm, velocity);
}

}  // namespace

std::optional<Vector2d> trace_back(const DipField& dip, const Landing& landing) {
  if (!landing.film_can_follow || landing.immersion_mm > dip.depth_mm) return std::nullopt;
  const auto after =
      std::upper_bound(dip.immersion_mm.begin(), dip.immersion_mm.end(), landing.immersion_mm);
  Vector2d point = landing.point_mm;
  Vector2d velocity = landing.pull;
  double from_mm = landing.immersion_mm;
  for (auto k = after - dip.immersion_mm.begin(); k-- > 0;) {
    if (!step_back(dip.fields[k], from_mm - dip.immersion_mm[k], point, velocity)) {
      return std::nullopt;
    }
    from_mm = dip.immersion_mm[k];
  }
  // Before first contact the film is at rest.
  point -= 0.5 * from_mm * velocity;
  if (!film::contains(dip.outline, point)) return std::nullopt;
  return point;
}

}  // namespace hydroprint::flow
