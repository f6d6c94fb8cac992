#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sim/mesh/rays.h"

namespace hydroprint::mesh {

/// Counts how often closed surfaces wind around points, with rays of one direction, which a
/// quadtree makes fast for many points. Rays through an edge count one of its triangles, so the
/// numbers are exact unless the point is on a triangle.
class ParallelRays {
 public:
  explicit ParallelRays(const std::vector<Corners>& triangles);
  ~ParallelRays();
  ParallelRays(const ParallelRays&) = delete;
  ParallelRays& operator=(const ParallelRays&) = delete;

  /// Returns the number of triangles that the ray from the point leaves the solid through, less
  /// those that it enters it through. May be called from several threads.
  [[nodiscard]] int winding(const Eigen::Vector3d& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::mesh
