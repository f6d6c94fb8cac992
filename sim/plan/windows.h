#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "sim/base/context.h"
#include "sim/plan/facets.h"

namespace hydroprint::plan {

/// Shortest paths that enter a triangle through an interval of one of its sides. They are straight
/// lines once the triangles before are unfolded into the plane of this one, and start either all at
/// one point, or all perpendicular to one line. Flat coordinates of the triangle, mm.
struct Window {
  int side = 0;  ///< of the triangle side / 3
  bool is_line = false;
  double from_mm = 0;  ///< the interval, from the start of the side
  double to_mm = 0;
  double start_mm = 0;        ///< distance at the source
  Eigen::Vector2d source;     ///< the point, or any point of the line
  Eigen::Vector2d direction;  ///< of all paths from a line; unit vector

  [[nodiscard]] double distance(const Eigen::Vector2d& p) const {
    return start_mm + (is_line ? direction.dot(p - source) : (p - source).norm());
  }
  /// Returns the direction of the path at a point.
  [[nodiscard]] Eigen::Vector2d ray(const Eigen::Vector2d& p) const {
    return is_line ? direction : Eigen::Vector2d(p - source);
  }
};

/// Where paths start in a triangle: a point, or a line segment that sends paths to both of its
/// sides. Flat coordinates.
struct PointSource {
  int triangle = 0;
  int side = -1;  ///< the side that contains the point; -1: inside the triangle
  Eigen::Vector2d at;
  /// Directions (unit vectors) in which segments leave this point. A path that starts at less than
  /// 90 degrees from one of them would be shorter from the segment.
  std::span<const Eigen::Vector2d> segments;
};
struct LineSource {
  int triangle = 0;
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

/// Exact geodesic distances by propagation of windows in order of distance (Chen and Han 1990; the
/// filter is that of Xin and Wang 2009, "Improving Chen and Han's algorithm", for two of the
/// vertices). Paths bend only at vertices with an angle above 360 degrees, at ends of edges with
/// one or more than two triangles, and at sources.
class Propagation {
 public:
  /// @param open      per triangle: 1 if paths may enter it; must outlive this object
  /// @param limit_mm  longer paths are not followed
  Propagation(const Facets& facets, const std::vector<char>& open, double limit_mm);

  void start_at_vertex(int vertex, double distance_mm);
  void start_at(const PointSource& source);
  void start_at(const LineSource& source);

  /// Follows all paths. Errors: kCancelled; kResourceExhausted if there are too many windows.
  [[nodiscard]] Status run(const Context& context);

  /// Returns the windows that may contain shortest paths, in order of their distance.
  [[nodiscard]] std::vector<Window> windows() const;
  /// Returns the distance of each vertex; infinity if it is beyond the limit.
  [[nodiscard]] const std::vector<double>& vertex_mm() const { return vertex_mm_; }

 private:
  struct Event {
    double distance_mm;
    std::int64_t index;  ///< of a window, or -1 - vertex
    bool operator>(const Event& other) const {
      return std::pair(distance_mm, index) > std::pair(other.distance_mm, other.index);
    }
  };

  void find_bends();
  void improve(int vertex, double distance_mm);
  void leave_vertex(int vertex);
  void traverse(Window window);
  void cross(const Window& beam, int side, double from_mm, double to_mm);
  void push(const Window& window);
  [[nodiscard]] bool is_dominated(const Window& window) const;

  const Facets& facets_;
  const std::vector<char>& open_;
  double limit_mm_;
  std::vector<double> vertex_mm_;
  std::vector<char> bends_;  ///< per vertex: paths may start or bend here
  std::vector<char> left_;   ///< per vertex: its paths have been sent
  std::vector<Window> all_;
  std::vector<std::int64_t> followed_;  ///< windows that were not dominated when followed
  std::priority_queue<Event, std::vector<Event>, std::greater<>> queue_;
};

/// Tolerance for places, mm: paths that miss a window or a vertex by less still count.
inline constexpr double kPlaceTolerance_mm = 1e-7;

}  // namespace hydroprint::plan
