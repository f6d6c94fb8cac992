#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "sim/base/context.h"
#include "sim/plan/facets.h"
#include "sim/plan/windows.h"

namespace hydroprint::plan {

/// A straight line in a triangle, to which distances are measured.
struct Source {
  int triangle = 0;
  std::array<Eigen::Vector3d, 2> ends;  ///< barycentric
};

/// Geodesic distances on a surface from lines on it, evaluated at any point.
class DistanceField {
 public:
  /// Without sources: every distance is infinite.
  DistanceField() = default;

  /// @param sources   in open triangles
  /// @param open      per triangle: 1 if paths may enter it
  /// @param limit_mm  larger distances are not computed
  /// Errors: kCancelled; kResourceExhausted if the limit is too large for the surface.
  [[nodiscard]] static Result<DistanceField> create(std::shared_ptr<const Facets> facets,
                                                    const std::vector<Source>& sources,
                                                    const std::vector<char>& open, double limit_mm,
                                                    const Context& context);

  /// Returns the length of the shortest path from the sources to a point of an open triangle, mm;
  /// infinity if it is beyond the limit. Exact up to rounding (1e-6 mm).
  [[nodiscard]] double at(int triangle, const Eigen::Vector3d& barycentric) const;

  /// Returns false if the distance of every point of the triangle is infinite.
  [[nodiscard]] bool comes_to(int triangle) const;

 private:
  struct Segment {
    Eigen::Vector2d from;
    Eigen::Vector2d to;
  };
  friend class SourceStarts;

  void index_windows(const std::vector<Window>& windows);
  void index_segments(const std::vector<std::pair<int, Segment>>& segments);

  std::shared_ptr<const Facets> facets_;
  double limit_mm_ = 0;
  std::vector<double> vertex_mm_;
  std::vector<std::size_t> window_begin_;  ///< per triangle
  std::vector<Window> windows_;
  std::vector<std::size_t> segment_begin_;  ///< per triangle
  std::vector<Segment> segments_;
};

}  // namespace hydroprint::plan
