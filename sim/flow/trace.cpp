#include "sim/flow/trace.h"

#include <algorithm>

namespace hydroprint::flow {
namespace {

/// Chords of the film mesh cut off this much of the film at most; farther outside is no film.
constexpr double kReach_mm = 0.08;
/// The predictor may overshoot the waterline, and a landing lies up to a step's waterlines apart
/// from either: they need some velocity all the same.
constexpr double kFarReach_mm = velocity::Locator::kReach_mm;

using Eigen::Vector2d;
using velocity::VelocityField;

/// One step of Heun's rule back to `field` over `span_mm`; `velocity` is that at the start and
/// becomes that at the end.
bool step_back(const VelocityField& field, double span_mm, Vector2d& point, Vector2d& velocity) {
  Vector2d before;
  if (!field.at(point - span_mm * velocity, kFarReach_mm, before)) before = velocity;
  point -= 0.5 * span_mm * (velocity + before);
  return field.at(point, kReach_mm, velocity);
}

/// The film's velocity at the landing.
/// @param after  index of the first waterline above it
/// @return false if neither the waterline before has film there still nor the one after again: the
///         landing is then not on the film's boundary at all
bool velocity_at(const DipField& dip, const Landing& landing, std::size_t after,
                 Vector2d& velocity) {
  velocity = landing.pull;
  Vector2d before_velocity = Vector2d::Zero();
  Vector2d after_velocity = Vector2d::Zero();
  const bool is_first = after == 0;  // the whole film is there before first contact
  const bool is_last = after == dip.fields.size();
  const double outside_before_mm =
      is_first ? 0 : dip.fields[after - 1].nearest(landing.point_mm, before_velocity);
  if (landing.is_smooth && outside_before_mm <= kReach_mm) return true;
  const double outside_after_mm = is_last
                                      ? VelocityField::kNoFilm_mm
                                      : dip.fields[after].nearest(landing.point_mm, after_velocity);
  if (std::min(outside_before_mm, outside_after_mm) > kReach_mm) return false;
  if (landing.is_smooth || is_first ||
      std::max(outside_before_mm, outside_after_mm) > kFarReach_mm) {
    return true;
  }
  const double share = (landing.immersion_mm - dip.immersion_mm[after - 1]) /
                       (dip.immersion_mm[after] - dip.immersion_mm[after - 1]);
  velocity = (1 - share) * before_velocity + share * after_velocity;
  return true;
}

}  // namespace

std::optional<Vector2d> trace_back(const DipField& dip, const Landing& landing) {
  if (!landing.film_can_follow || landing.immersion_mm > dip.depth_mm) return std::nullopt;
  const auto after = static_cast<std::size_t>(
      std::upper_bound(dip.immersion_mm.begin(), dip.immersion_mm.end(), landing.immersion_mm) -
      dip.immersion_mm.begin());
  Vector2d point = landing.point_mm;
  Vector2d velocity;
  if (!velocity_at(dip, landing, after, velocity)) return std::nullopt;
  double from_mm = landing.immersion_mm;
  for (std::size_t k = after; k-- > 0;) {
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
