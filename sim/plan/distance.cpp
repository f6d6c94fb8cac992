#include "sim/plan/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/base/check.h"

namespace hydroprint::plan {
namespace {

/// An end of a source on an edge, in coordinates of the edge's first side: x along it, and y into
/// the triangle of the source.
struct EdgeEnd {
  std::size_t edge;
  double x_mm;
  int side;
  Eigen::Vector2d away;  ///< unit vector along the source, away from this end
};

double segment_distance(const Eigen::Vector2d& p, const Eigen::Vector2d& from,
                        const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp(along.dot(p - from) / squared, 0.0, 1.0) : 0;
  return (p - from - t * along).norm();
}

/// Returns true if the path from a window's source to a point passes through the window.
bool passes(const Window& window, const SideFrame& side, const Eigen::Vector2d& p) {
  const Eigen::Vector2d ray = window.ray(p);
  const double height = side.inward.dot(p - side.origin);
  const double rise = side.inward.dot(ray);
  const double x =
      side.along.dot(p - side.origin) - (rise > 0 ? height / rise * side.along.dot(ray) : 0);
  return x >= window.from_mm - kPlaceTolerance_mm && x <= window.to_mm + kPlaceTolerance_mm;
}

template <class Item, class TriangleOf>
std::vector<std::size_t> count_by_triangle(std::size_t triangles, const std::vector<Item>& items,
                                           const TriangleOf& triangle_of) {
  std::vector<std::size_t> begin(triangles + 1, 0);
  for (const auto& item : items) ++begin[static_cast<std::size_t>(triangle_of(item)) + 1];
  for (std::size_t t = 0; t < triangles; ++t) begin[t + 1] += begin[t];
  return begin;
}

}  // namespace

/// Starts paths from sources: from each line, and from its ends in all triangles around them.
class SourceStarts {
 public:
  using Segment = DistanceField::Segment;

  SourceStarts(const Facets& facets, const std::vector<char>& open, Propagation& paths)
      : facets_(facets), open_(open), paths_(paths) {}

  void add(const Source& source) {
    const Segment segment = {facets_.flat(source.triangle, source.ends[0]),
                             facets_.flat(source.triangle, source.ends[1])};
    segments_.emplace_back(source.triangle, segment);
    paths_.start_at(LineSource{source.triangle, segment.from, segment.to});
    const Eigen::Vector2d along = (segment.to - segment.from).normalized();
    add_end(source.triangle, segment.from, along);
    add_end(source.triangle, segment.to, -along);
  }

  /// Starts the paths from ends on edges and returns all sources, per triangle.
  std::vector<std::pair<int, Segment>> finish() {
    std::stable_sort(ends_.begin(), ends_.end(), [](const EdgeEnd& a, const EdgeEnd& b) {
      return std::pair(a.edge, a.x_mm) < std::pair(b.edge, b.x_mm);
    });
    for (std::size_t i = 0; i < ends_.size();) {
      std::size_t end = i + 1;
      while (end < ends_.size() && ends_[end].edge == ends_[i].edge &&
             ends_[end].x_mm - ends_[i].x_mm < kPlaceTolerance_mm)
        ++end;
      start_on_edge(std::span(ends_).subspan(i, end - i));
      i = end;
    }
    return std::move(segments_);
  }

 private:
  void add_end(int triangle, const Eigen::Vector2d& at, const Eigen::Vector2d& away) {
    const auto& corners = facets_.corners(triangle);
    for (int c = 0; c < 3; ++c) {
      const double distance = (at - corners[static_cast<std::size_t>(c)]).norm();
      if (distance > kPlaceTolerance_mm) continue;
      paths_.start_at_vertex(facets_.vertex(3 * triangle + c), distance);
      return;
    }
    for (int side = 3 * triangle; side < 3 * triangle + 3; ++side) {
      if (add_edge_end(side, at, away)) return;
    }
    paths_.start_at(PointSource{triangle, -1, at, std::span(&away, 1)});
  }

  bool add_edge_end(int side, const Eigen::Vector2d& at, const Eigen::Vector2d& away) {
    const SideFrame frame = facets_.frame(side);
    if (std::abs(frame.inward.dot(at - frame.origin)) > kPlaceTolerance_mm) return false;
    const double x = frame.along.dot(at - frame.origin);
    const Eigen::Vector2d direction(frame.along.dot(away), frame.inward.dot(away));
    const std::size_t edge = facets_.edge(side);
    if (facets_.same_direction(facets_.edges().sides(edge).front(), side))
      ends_.push_back({edge, x, side, direction});
    else
      ends_.push_back({edge, frame.length_mm - x, side, {-direction.x(), direction.y()}});
    return true;
  }

  /// Starts paths from one point on an edge into all triangles there.
  void start_on_edge(std::span<const EdgeEnd> ends) {
    const auto sides = facets_.edges().sides(ends.front().edge);
    for (const int side : sides) {
      if (open_[static_cast<std::size_t>(side / 3)] == 0) continue;
      const bool same = facets_.same_direction(sides.front(), side);
      const SideFrame frame = facets_.frame(side);
      const double x = same ? ends.front().x_mm : frame.length_mm - ends.front().x_mm;
      std::vector<Eigen::Vector2d> away;
      for (const auto& end : ends) {
        // Sources of other triangles are unfolded into this one's plane.
        const double y = end.side == side ? end.away.y() : -end.away.y();
        away.emplace_back((same ? 1 : -1) * end.away.x() * frame.along + y * frame.inward);
      }
      paths_.start_at(PointSource{side / 3, side, frame.point(x), away});
      segments_.push_back({side / 3, {frame.point(x), frame.point(x)}});
    }
  }

  const Facets& facets_;
  const std::vector<char>& open_;
  Propagation& paths_;
  std::vector<EdgeEnd> ends_;
  std::vector<std::pair<int, Segment>> segments_;
};

Result<DistanceField> DistanceField::create(std::shared_ptr<const Facets> facets,
                                            const std::vector<Source>& sources,
                                            const std::vector<char>& open, double limit_mm,
                                            const Context& context) {
  DistanceField field;
  if (sources.empty()) return field;
  field.facets_ = std::move(facets);
  field.limit_mm_ = limit_mm;
  Propagation paths(*field.facets_, open, limit_mm);
  SourceStarts starts(*field.facets_, open, paths);
  for (const auto& source : sources) {
    HP_CHECK(open[static_cast<std::size_t>(source.triangle)] != 0);
    starts.add(source);
  }
  field.index_segments(starts.finish());
  HP_RETURN_IF_ERROR(paths.run(context));
  field.index_windows(paths.windows());
  field.vertex_mm_ = paths.vertex_mm();
  return field;
}

void DistanceField::index_windows(const std::vector<Window>& windows) {
  window_begin_ = count_by_triangle(facets_->size(), windows,
                                    [](const Window& window) { return window.side / 3; });
  windows_.resize(windows.size());
  auto next = window_begin_;
  for (const auto& window : windows)
    windows_[next[static_cast<std::size_t>(window.side / 3)]++] = window;
}

void DistanceField::index_segments(const std::vector<std::pair<int, Segment>>& segments) {
  segment_begin_ = count_by_triangle(facets_->size(), segments,
                                     [](const auto& segment) { return segment.first; });
  segments_.resize(segments.size());
  auto next = segment_begin_;
  for (const auto& [triangle, segment] : segments)
    segments_[next[static_cast<std::size_t>(triangle)]++] = segment;
}

double DistanceField::at(int triangle, const Eigen::Vector3d& barycentric) const {
  double least = std::numeric_limits<double>::infinity();
  if (!facets_) return least;
  const auto t = static_cast<std::size_t>(triangle);
  const Eigen::Vector2d p = facets_->flat(triangle, barycentric);
  for (int c = 0; c < 3; ++c) {
    const auto v = static_cast<std::size_t>(facets_->vertex(3 * triangle + c));
    const auto& corner = facets_->corners(triangle)[static_cast<std::size_t>(c)];
    least = std::min(least, vertex_mm_[v] + (p - corner).norm());
  }
  for (std::size_t i = segment_begin_[t]; i < segment_begin_[t + 1]; ++i)
    least = std::min(least, segment_distance(p, segments_[i].from, segments_[i].to));
  const std::array<SideFrame, 3> sides = {facets_->frame(3 * triangle),
                                          facets_->frame(3 * triangle + 1),
                                          facets_->frame(3 * triangle + 2)};
  for (std::size_t i = window_begin_[t]; i < window_begin_[t + 1]; ++i) {
    const Window& window = windows_[i];
    if (!passes(window, sides[static_cast<std::size_t>(window.side % 3)], p)) continue;
    least = std::min(least, window.distance(p));
  }
  return least <= limit_mm_ ? least : std::numeric_limits<double>::infinity();
}

bool DistanceField::comes_to(int triangle) const {
  if (!facets_) return false;
  const auto t = static_cast<std::size_t>(triangle);
  if (window_begin_[t] != window_begin_[t + 1] || segment_begin_[t] != segment_begin_[t + 1])
    return true;
  for (int c = 0; c < 3; ++c) {
    const auto v = static_cast<std::size_t>(facets_->vertex(3 * triangle + c));
    if (vertex_mm_[v] <= limit_mm_) return true;
  }
  return false;
}

}  // namespace hydroprint::plan
