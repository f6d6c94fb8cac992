#include "sim/flow/trace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "sim/base/check.h"
#include "sim/velocity/quadratic_elements.h"

namespace hydroprint::flow {
namespace {

/// Chords of the film mesh cut off at most this much of the film. Points farther outside have no
/// film.
constexpr double kReach_mm = 0.08;
/// A step may overshoot the waterline, and a landing may be as far from its neighbouring waterlines
/// as they are from each other. Such points still need a velocity. (The start of each path decides
/// whether its landing has film at all.)
constexpr double kFarReach_mm = velocity::Locator::kReach_mm;

using Eigen::Vector2d;
using velocity::VelocityField;

/// If a step is at least this many times longer than the previous one, the multistep rule restarts:
/// the short step crossed an event, where the velocity jumps.
constexpr double kMostGrowth = 4;

/// Number of points followed together: the more, the closer neighbours are, but at least some
/// chunks for each thread.
constexpr std::size_t kLeastChunk = 512, kMostChunk = 8192, kChunks = 64;

/// A point of the film, traced back through the dip.
struct BackPath {
  Vector2d point_mm;  ///< NaN: lost
  double immersion_mm;
  Vector2d velocity;                           ///< velocity of the film at that point and immersion
  std::size_t after;                           ///< number of waterlines still before it
  Vector2d later_velocity = Vector2d::Zero();  ///< velocity one step later in the dip
  double later_span_mm = 0;
  bool keeps_on = false;  ///< where there is no film, keeps its velocity instead of being lost

  [[nodiscard]] bool is_lost() const { return std::isnan(point_mm.x()); }
  void lose() { point_mm.setConstant(std::numeric_limits<double>::quiet_NaN()); }
};

/// Returns the displacement over a step, from the velocity at its start and the predicted one at
/// its end. The velocity is interpolated in time through these and the previous velocity
/// (Adams-Moulton rule for uneven steps), or linearly where the rule restarts (kMostGrowth).
Vector2d displacement(const BackPath& path, double span_mm, const Vector2d& end_velocity) {
  const double g = path.later_span_mm;
  const double h = span_mm;
  if (h >= kMostGrowth * g) return 0.5 * h * (path.velocity + end_velocity);
  return h * (2 * h + 3 * g) / (6 * (h + g)) * end_velocity +
         h * (h + 3 * g) / (6 * g) * path.velocity -
         h * h * h / (6 * g * (h + g)) * path.later_velocity;
}

/// Same as displacement(), before the velocity at the end is known.
Vector2d predicted_displacement(const BackPath& path, double span_mm) {
  Vector2d out = span_mm * path.velocity;
  if (span_mm < kMostGrowth * path.later_span_mm) {
    out += span_mm * span_mm / (2 * path.later_span_mm) * (path.velocity - path.later_velocity);
  }
  return out;
}

/// Traces one step back to the waterline at `immersion_mm`; the path is lost where the field has no
/// film.
/// @param triangle  of the film mesh, near the point if possible; set to the one that contains the
///                  point
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

/// Returns an order in which consecutive paths begin near each other: up and down narrow strips.
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

/// Follows all paths back through the dip together, waterline by waterline, so that each film mesh
/// is read only once.
/// @param first  the waterline at which the paths end
void follow_back(const DipField& dip, std::vector<BackPath>& paths, std::size_t first = 0) {
  std::size_t most = 0;
  for (const BackPath& path : paths) most = std::max(most, path.after);
  const std::vector<std::size_t> order = neighbours_in_turn(paths);
  for (std::size_t k = most; k-- > first;) {
    int triangle = -1;
    for (const std::size_t i : order) {
      BackPath& path = paths[i];
      if (path.after == k + 1 && !path.is_lost())
        step_back(dip.fields[k], dip.immersion_mm[k], triangle, path);
    }
  }
}

/// Traces the last step of each path, to before first contact.
void come_to_rest(const DipField& dip, std::vector<BackPath>& paths) {
  for (BackPath& path : paths) {
    if (path.is_lost()) continue;
    // Before first contact the film is at rest.
    path.point_mm -= displacement(path, path.immersion_mm, Vector2d::Zero());
    if (!path.keeps_on && !film::contains(dip.outline, path.point_mm)) path.lose();
  }
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

/// Returns the path that ends in a landing; it is lost if no film arrives.
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

}  // namespace

Result<std::vector<Vector2d>> trace_back(const DipField& dip, const std::vector<Landing>& landings,
                                         std::string_view stage, const Context& context) {
  HP_CHECK(dip.immersion_mm.size() == dip.fields.size());
  HP_CHECK(std::is_sorted(dip.immersion_mm.begin(), dip.immersion_mm.end()));
  std::vector<Vector2d> film_mm(landings.size());
  const std::vector<std::size_t> order = by_immersion(landings);
  const std::size_t chunk = std::clamp(order.size() / kChunks, kLeastChunk, kMostChunk);
  const std::size_t chunks = (order.size() + chunk - 1) / chunk;
  HP_RETURN_IF_ERROR(parallel_for(context, stage, chunks, [&](std::size_t c) -> Status {
    const std::size_t first = c * chunk;
    const std::size_t last = std::min(first + chunk, order.size());
    std::vector<BackPath> paths;
    paths.reserve(last - first);
    for (std::size_t i = first; i < last; ++i) paths.push_back(path_to(dip, landings[order[i]]));
    follow_back(dip, paths);
    come_to_rest(dip, paths);
    for (std::size_t i = first; i < last; ++i) film_mm[order[i]] = paths[i - first].point_mm;
    return {};
  }));
  return film_mm;
}

std::optional<Vector2d> trace_back(const DipField& dip, const Landing& landing) {
  std::vector<BackPath> paths = {path_to(dip, landing)};
  follow_back(dip, paths);
  come_to_rest(dip, paths);
  if (paths[0].is_lost()) return std::nullopt;
  return paths[0].point_mm;
}

std::vector<Vector2d> trace_back(const DipField& dip, std::size_t k, const RestMap* known) {
  HP_CHECK(k < dip.fields.size());
  HP_CHECK(known == nullptr || known->waterline <= k);
  const VelocityField& field = dip.fields[k];
  std::vector<BackPath> paths;
  paths.reserve(field.nodes().size());
  for (std::size_t n = 0; n < field.nodes().size(); ++n) {
    BackPath& path = paths.emplace_back(
        BackPath{velocity::place_of(field.mesh(), n), dip.immersion_mm[k], field.nodes()[n], k});
    path.keeps_on = true;  // nodes of the film mesh are certainly film
  }
  follow_back(dip, paths, known != nullptr ? known->waterline : 0);
  if (known == nullptr) come_to_rest(dip, paths);
  std::vector<Vector2d> rest_mm(paths.size());
  for (std::size_t n = 0; n < paths.size(); ++n) {
    rest_mm[n] = paths[n].point_mm;
    if (known == nullptr) continue;
    const bool is_film = known->rest_mm.at(paths[n].point_mm, kFarReach_mm, rest_mm[n]);
    if (!is_film) rest_mm[n].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return rest_mm;
}

}  // namespace hydroprint::flow
