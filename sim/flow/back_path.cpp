#include "sim/flow/back_path.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
using velocity::VelocityField;

/// Chords of the film mesh cut off at most this much of the film. Points farther outside have no
/// film.
constexpr double kReach_mm = 0.08;
/// Growth of the steps from which the multistep rule restarts.
constexpr double kMostGrowth = 4;

/// Returns the displacement over a step, from the velocity at its start and the predicted one at
/// its end. The velocity is interpolated in time through these and the previous velocity
/// (Adams-Moulton rule for uneven steps), or linearly where the rule restarts (kMostGrowth).
Vector2d displacement(const BackPath& path, double span_mm, const Vector2d& end_velocity) {
  const double g = path.later_span_mm;
  const double h = span_mm;
  if (restarts(h, g)) return 0.5 * h * (path.velocity + end_velocity);
  return h * (2 * h + 3 * g) / (6 * (h + g)) * end_velocity +
         h * (h + 3 * g) / (6 * g) * path.velocity -
         h * h * h / (6 * g * (h + g)) * path.later_velocity;
}

/// Same as displacement(), before the velocity at the end is known.
Vector2d predicted_displacement(const BackPath& path, double span_mm) {
  Vector2d out = span_mm * path.velocity;
  if (!restarts(span_mm, path.later_span_mm)) {
    out += span_mm * span_mm / (2 * path.later_span_mm) * (path.velocity - path.later_velocity);
  }
  return out;
}

/// Number of points followed together: the more, the closer neighbours are, but at least some
/// parts for each thread.
constexpr std::size_t kLeastPart = 512, kMostPart = 8192, kParts = 64;

std::vector<std::size_t> by_immersion(const std::vector<Landing>& landings) {
  std::vector<std::size_t> order(landings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double depth_a = landings[a].immersion_mm;
    const double depth_b = landings[b].immersion_mm;
    return depth_a != depth_b ? depth_a < depth_b : a < b;
  });
  return order;
}

/// Computes the film's velocity at the landing.
/// @param after  index of the first waterline after the landing
/// @return false if there is film neither at the waterline before nor at the one after. The landing
///         is then not on the film's boundary at all
bool velocity_at(const DipField& dip, const Landing& landing, std::size_t after,
                 Vector2d& velocity) {
  velocity = landing.pull;
  Vector2d before_velocity = Vector2d::Zero();
  Vector2d after_velocity = Vector2d::Zero();
  const bool is_first = after == 0;  // the whole film is present before first contact
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

bool restarts(double span_mm, double previous_span_mm) {
  return span_mm >= kMostGrowth * previous_span_mm;
}

void step_back(const VelocityField& field, double immersion_mm, int& triangle, BackPath& path) {
  const double span_mm = path.immersion_mm - immersion_mm;
  Vector2d before = path.velocity;
  const Vector2d predicted = predicted_displacement(path, span_mm);
  (void)field.at(path.point_mm - predicted, kFarReach_mm, before, triangle);
  const Vector2d corrected = displacement(path, span_mm, before);
  path.point_mm -= corrected;
  path.later_velocity = path.velocity;
  path.later_span_mm = span_mm;
  path.immersion_mm = immersion_mm;
  --path.after;
  // The step may have cut off a corner of the waterline by as much as the results of the two rules
  // differ.
  const double reach_mm = path.keeps_on
                              ? kFarReach_mm
                              : std::min(kFarReach_mm, kReach_mm + (corrected - predicted).norm());
  const bool is_film = field.at(path.point_mm, reach_mm, path.velocity, triangle);
  if (!is_film && !path.keeps_on) path.lose();
}

std::vector<std::size_t> neighbours_in_turn(const std::vector<BackPath>& paths) {
  constexpr double kStrip_mm = 4;
  struct Key {
    double strip, along;
    std::size_t index;
  };
  std::vector<Key> keys;
  keys.reserve(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (paths[i].is_lost()) continue;
    const Vector2d& p = paths[i].point_mm;
    const double strip = std::floor(p.x() / kStrip_mm);
    keys.push_back({strip, std::fmod(strip, 2) == 0 ? p.y() : -p.y(), i});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.strip, a.along, a.index) < std::tie(b.strip, b.along, b.index);
  });
  std::vector<std::size_t> order;
  order.reserve(keys.size());
  for (const Key& key : keys) order.push_back(key.index);
  return order;
}

void follow_back(const DipField& dip, const std::vector<std::size_t>& order, std::size_t first,
                 std::vector<BackPath>& paths) {
  std::size_t most = 0;
  for (const BackPath& path : paths) most = std::max(most, path.after);
  for (std::size_t k = most; k-- > first;) {
    const bool knows_tears = k < dip.is_torn.size() && !dip.is_torn[k].empty();
    int triangle = -1;
    for (const std::size_t i : order) {
      BackPath& path = paths[i];
      if (path.after != k + 1 || path.is_lost()) continue;
      step_back(dip.fields[k], dip.immersion_mm[k], triangle, path);
      if (knows_tears && triangle >= 0 && dip.is_torn[k][triangle] != 0) path.has_torn = true;
    }
  }
}

void come_to_rest(const DipField& dip, std::vector<BackPath>& paths) {
  for (BackPath& path : paths) {
    if (path.is_lost()) continue;
    // Before first contact the film is at rest.
    path.point_mm -= displacement(path, path.immersion_mm, Vector2d::Zero());
    if (!path.keeps_on && !film::contains(dip.outline, path.point_mm)) path.lose();
  }
}

BackPath path_to(const DipField& dip, const Landing& landing) {
  const auto after = static_cast<std::size_t>(
      std::upper_bound(dip.immersion_mm.begin(), dip.immersion_mm.end(), landing.immersion_mm) -
      dip.immersion_mm.begin());
  BackPath path{landing.point_mm, landing.immersion_mm, Vector2d::Zero(), after};
  const bool arrives = landing.film_can_follow && landing.immersion_mm <= dip.depth_mm &&
                       velocity_at(dip, landing, after, path.velocity);
  if (!arrives) path.lose();
  return path;
}

std::vector<BackPath> paths_to(const DipField& dip, const std::vector<Landing>& landings,
                               const Part& part) {
  std::vector<BackPath> paths;
  paths.reserve(part.size());
  for (const std::size_t v : part) paths.push_back(path_to(dip, landings[v]));
  return paths;
}

Status for_each_part(const std::vector<Landing>& landings, std::string_view stage,
                     const Context& context, const std::function<void(const Part&)>& trace) {
  const std::vector<std::size_t> order = by_immersion(landings);
  const std::size_t size = std::clamp(order.size() / kParts, kLeastPart, kMostPart);
  const std::size_t parts = (order.size() + size - 1) / size;
  return parallel_for(context, stage, parts, [&](std::size_t p) -> Status {
    const auto at = [&](std::size_t i) {
      return order.begin() + static_cast<std::ptrdiff_t>(std::min(i, order.size()));
    };
    trace(Part(at(p * size), at((p + 1) * size)));
    return {};
  });
}

}  // namespace hydroprint::flow
