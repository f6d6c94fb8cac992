#include "sim/plan/windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace hydroprint::plan {
namespace {

constexpr double kDistanceTolerance = 1e-9;  // mm; rounding errors are far below
constexpr double kLeastWidth = 1e-9;         // mm; narrower beams are rounding errors
constexpr double kAngleTolerance = 1e-8;     // rad
constexpr std::size_t kMostWindows = 40'000'000;
constexpr std::size_t kEventsPerCheck = 4096;

double cross_product(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

struct Interval {
  double from;
  double to;
};

/// Keeps the part of an interval where a linear function, given at both ends, is not negative.
std::optional<Interval> clip_interval(Interval x, double at_from, double at_to) {
  if (at_from < 0 && at_to < 0) return std::nullopt;
  const double zero = at_from == at_to ? x.from : at_from / (at_from - at_to);
  if (at_from < 0) return Interval{x.from + zero * (x.to - x.from), x.to};
  if (at_to < 0) return Interval{x.from, x.from + zero * (x.to - x.from)};
  return x;
}

/// Returns where a ray meets the line from `origin` along a unit vector, within [0, length].
double meet(const Eigen::Vector2d& start, const Eigen::Vector2d& ray, const Eigen::Vector2d& origin,
            const Eigen::Vector2d& along, double length) {
  const double across = cross_product(along, ray);
  if (across == 0) return length;
  return std::clamp(cross_product(start - origin, ray) / across, 0.0, length);
}

/// Returns the width of a beam at a side, perpendicular to its paths. Paths along the side itself
/// have none: those on either side of it lead to the same places.
double beam_width(const Window& beam, const SideFrame& side, double from_mm, double to_mm) {
  const Eigen::Vector2d first = beam.ray(side.point(from_mm));
  const Eigen::Vector2d last = beam.ray(side.point(to_mm));
  const double longest = std::max(first.norm(), last.norm());
  return longest > 0 ? (to_mm - from_mm) * -side.inward.dot(first) / longest : 0;
}

int opposite_side(int corner) { return corner - corner % 3 + (corner + 1) % 3; }

double corner_angle(const Facets& facets, int corner) {
  const auto& c = facets.corners(corner / 3);
  const auto i = static_cast<std::size_t>(corner % 3);
  const Eigen::Vector2d a = c[(i + 1) % 3] - c[i];
  const Eigen::Vector2d b = c[(i + 2) % 3] - c[i];
  return std::atan2(cross_product(a, b), a.dot(b));
}

/// Returns true if a side contains the point.
bool is_on(const SideFrame& frame, const Eigen::Vector2d& p) {
  return std::abs(frame.inward.dot(p - frame.origin)) < kPlaceTolerance_mm;
}

}  // namespace

Propagation::Propagation(const Facets& facets, const std::vector<char>& open, double limit_mm)
    : facets_(facets),
      open_(open),
      limit_mm_(limit_mm),
      vertex_mm_(facets.vertices(), std::numeric_limits<double>::infinity()),
      bends_(facets.vertices(), 0),
      left_(facets.vertices(), 0) {
  find_bends();
}

void Propagation::find_bends() {
  std::vector<double> angle(facets_.vertices(), 0);
  for (std::size_t t = 0; t < facets_.size(); ++t) {
    if (open_[t] == 0) continue;
    for (int c = 0; c < 3; ++c) {
      const int corner = 3 * static_cast<int>(t) + c;
      angle[static_cast<std::size_t>(facets_.vertex(corner))] += corner_angle(facets_, corner);
    }
  }
  for (std::size_t v = 0; v < angle.size(); ++v)
    bends_[v] = angle[v] > 2 * std::numbers::pi + kAngleTolerance ? 1 : 0;
  for (std::size_t e = 0; e < facets_.edges().size(); ++e) {
    const auto sides = facets_.edges().sides(e);
    const auto count = std::count_if(sides.begin(), sides.end(), [&](int side) {
      return open_[static_cast<std::size_t>(side / 3)] != 0;
    });
    if (count == 2) continue;
    for (const int side : sides)
      for (const int corner : {side, opposite_side(side)})
        bends_[static_cast<std::size_t>(facets_.vertex(corner))] = 1;
  }
}

void Propagation::improve(int vertex, double distance_mm) {
  const auto v = static_cast<std::size_t>(vertex);
  if (distance_mm >= vertex_mm_[v] || distance_mm > limit_mm_) return;
  vertex_mm_[v] = distance_mm;
  if (bends_[v] != 0 && left_[v] == 0) queue_.push({distance_mm, -1 - std::int64_t{vertex}});
}

void Propagation::start_at_vertex(int vertex, double distance_mm) {
  const auto v = static_cast<std::size_t>(vertex);
  bends_[v] = 1;
  vertex_mm_[v] = std::min(vertex_mm_[v], distance_mm);
  queue_.push({vertex_mm_[v], -1 - std::int64_t{vertex}});
}

void Propagation::start_at(const PointSource& source) {
  Window beam;
  beam.source = source.at;
  beam.direction.setZero();
  for (int side = 3 * source.triangle; side < 3 * source.triangle + 3; ++side) {
    const SideFrame frame = facets_.frame(side);
    improve(facets_.vertex(side), (frame.origin - source.at).norm());
    if (side == source.side) continue;
    std::optional<Interval> x = Interval{0, frame.length_mm};
    for (const auto& segment : source.segments) {
      if (!x) break;
      const auto behind = [&](double at) {
        return kPlaceTolerance_mm - segment.dot(frame.point(at) - source.at);
      };
      x = clip_interval(*x, behind(x->from), behind(x->to));
    }
    if (x) cross(beam, side, x->from, x->to);
  }
}

void Propagation::start_at(const LineSource& source) {
  const double length = (source.to - source.from).norm();
  if (length < kLeastWidth) return;
  const Eigen::Vector2d along = (source.to - source.from) / length;
  for (int corner = 3 * source.triangle; corner < 3 * source.triangle + 3; ++corner) {
    const Eigen::Vector2d offset = facets_.frame(corner).origin - source.from;
    const double foot = std::clamp(along.dot(offset), 0.0, length);
    improve(facets_.vertex(corner), (offset - foot * along).norm());
  }
  Window beam;
  beam.is_line = true;
  beam.source = source.from;
  for (const double sign : {1.0, -1.0}) {
    beam.direction = sign * Eigen::Vector2d(-along.y(), along.x());
    for (int side = 3 * source.triangle; side < 3 * source.triangle + 3; ++side) {
      const SideFrame frame = facets_.frame(side);
      if (is_on(frame, source.from) && is_on(frame, source.to)) continue;
      std::optional<Interval> x = Interval{0, frame.length_mm};
      const auto clip = [&](auto value) {
        if (x) x = clip_interval(*x, value(frame.point(x->from)), value(frame.point(x->to)));
      };
      clip([&](const Eigen::Vector2d& p) { return beam.distance(p); });
      clip([&](const Eigen::Vector2d& p) { return along.dot(p - source.from); });
      clip([&](const Eigen::Vector2d& p) { return along.dot(source.to - p); });
      if (x) cross(beam, side, x->from, x->to);
    }
  }
}

Status Propagation::run(const Context& context) {
  for (std::size_t count = 0; !queue_.empty(); ++count) {
    if (count % kEventsPerCheck == 0) HP_RETURN_IF_ERROR(check_cancelled(context));
    if (all_.size() > kMostWindows)
      return fail(Code::kResourceExhausted,
                  "The blend needs too many steps on this surface. Use a smaller blend width.");
    const Event event = queue_.top();
    queue_.pop();
    if (event.index < 0) {
      leave_vertex(static_cast<int>(-1 - event.index));
      continue;
    }
    const Window& window = all_[static_cast<std::size_t>(event.index)];
    if (is_dominated(window)) continue;
    followed_.push_back(event.index);
    traverse(window);
  }
  return {};
}

void Propagation::leave_vertex(int vertex) {
  const auto v = static_cast<std::size_t>(vertex);
  if (left_[v] != 0) return;
  left_[v] = 1;
  for (const int corner : facets_.corners_at(vertex)) {
    if (open_[static_cast<std::size_t>(corner / 3)] == 0) continue;
    Window beam;
    beam.source = facets_.corners(corner / 3)[static_cast<std::size_t>(corner % 3)];
    beam.direction.setZero();
    beam.start_mm = vertex_mm_[v];
    const int side = opposite_side(corner);
    const SideFrame frame = facets_.frame(side);
    improve(facets_.vertex(side), beam.distance(frame.origin));
    improve(facets_.vertex(opposite_side(side)), beam.distance(frame.point(frame.length_mm)));
    cross(beam, side, 0, frame.length_mm);
  }
}

void Propagation::traverse(Window window) {
  const SideFrame entry = facets_.frame(window.side);
  const int right_side = opposite_side(window.side);  // from the far end of the entry to the apex
  const int left_side = opposite_side(right_side);
  const Eigen::Vector2d left = entry.point(window.from_mm);
  const Eigen::Vector2d right = entry.point(window.to_mm);
  const Eigen::Vector2d left_ray = window.ray(left);
  const Eigen::Vector2d right_ray = window.ray(right);
  const Eigen::Vector2d apex =
      facets_.corners(window.side / 3)[static_cast<std::size_t>(left_side % 3)];
  // Distances of the apex from the rays, positive within the beam.
  const double from_left = cross_product(apex - left, left_ray) / left_ray.norm();
  const double from_right = cross_product(right_ray, apex - right) / right_ray.norm();
  if (from_left >= -kPlaceTolerance_mm && from_right >= -kPlaceTolerance_mm)
    improve(facets_.vertex(left_side), window.distance(apex));

  const SideFrame left_frame = facets_.frame(left_side);  // runs from the apex
  const SideFrame right_frame = facets_.frame(right_side);
  const auto on_left = [&](const Eigen::Vector2d& start, const Eigen::Vector2d& ray) {
    return meet(start, ray, left_frame.origin, left_frame.along, left_frame.length_mm);
  };
  const auto on_right = [&](const Eigen::Vector2d& start, const Eigen::Vector2d& ray) {
    return meet(start, ray, right_frame.origin, right_frame.along, right_frame.length_mm);
  };
  if (from_left > 0)
    cross(window, left_side, from_right > 0 ? 0 : on_left(right, right_ray),
          on_left(left, left_ray));
  if (from_right > 0)
    cross(window, right_side, on_right(right, right_ray),
          from_left > 0 ? right_frame.length_mm : on_right(left, left_ray));
}

void Propagation::cross(const Window& beam, int side, double from_mm, double to_mm) {
  const SideFrame exit = facets_.frame(side);
  if (beam_width(beam, exit, from_mm, to_mm) < kLeastWidth) return;
  for (const int other : facets_.edges().sides(facets_.edge(side))) {
    if (other == side || open_[static_cast<std::size_t>(other / 3)] == 0) continue;
    const SideFrame entry = facets_.frame(other);
    const bool same = facets_.same_direction(side, other);
    const double sign = same ? 1 : -1;
    const auto turn = [&](const Eigen::Vector2d& v) -> Eigen::Vector2d {
      return sign * exit.along.dot(v) * entry.along - exit.inward.dot(v) * entry.inward;
    };
    Window window = beam;
    window.side = other;
    window.from_mm = same ? from_mm : exit.length_mm - to_mm;
    window.to_mm = same ? to_mm : exit.length_mm - from_mm;
    window.source = entry.point(same ? 0 : exit.length_mm) + turn(beam.source - exit.origin);
    window.direction = turn(beam.direction);
    push(window);
  }
}

void Propagation::push(const Window& window) {
  const SideFrame frame = facets_.frame(window.side);
  double nearest = 0;
  if (window.is_line) {
    nearest = std::min(window.distance(frame.point(window.from_mm)),
                       window.distance(frame.point(window.to_mm)));
  } else {
    const double x = frame.along.dot(window.source - frame.origin);
    nearest = window.distance(frame.point(std::clamp(x, window.from_mm, window.to_mm)));
  }
  if (nearest > limit_mm_ || is_dominated(window)) return;
  queue_.push({nearest, static_cast<std::int64_t>(all_.size())});
  all_.push_back(window);
}

/// A window is useless if the path from an end of its side, along the side, is shorter at the far
/// end of the interval: then it is shorter in all of the interval, because the distance within the
/// window changes by at most the length that one moves.
bool Propagation::is_dominated(const Window& window) const {
  const SideFrame frame = facets_.frame(window.side);
  const auto start = static_cast<std::size_t>(facets_.vertex(window.side));
  const auto end = static_cast<std::size_t>(facets_.vertex(opposite_side(window.side)));
  return window.distance(frame.point(window.to_mm)) >
             vertex_mm_[start] + window.to_mm + kDistanceTolerance ||
         window.distance(frame.point(window.from_mm)) >
             vertex_mm_[end] + frame.length_mm - window.from_mm + kDistanceTolerance;
}

std::vector<Window> Propagation::windows() const {
  std::vector<Window> kept;
  for (const auto index : followed_) {
    const Window& window = all_[static_cast<std::size_t>(index)];
    if (!is_dominated(window)) kept.push_back(window);
  }
  return kept;
}

}  // namespace hydroprint::plan
