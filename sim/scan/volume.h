#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/scan/frame.h"
#include "sim/scan/marching.h"
#include "sim/scan/noise.h"
#include "sim/scan/optics.h"
#include "sim/scan/point_grid.h"

namespace hydroprint::scan {

/// Truncated signed distances to the visible surfaces, positive in front of a surface. The grid has
/// blocks only near surfaces (Curless and Levoy 1996; Izadi et al. 2011, section 3). Frame W.
class Volume {
 public:
  struct Options {
    double voxel_mm = 3;
    double truncation_mm = 12;        ///< about eight standard deviations of depth at 0.8 m
    std::size_t most_blocks = 60000;  ///< maximum number of blocks of 4 KiB
  };

  /// @param box_mm  bounds of the volume
  Volume(const Eigen::AlignedBox3d& box_mm, const Options& options);

  /// Adds a frame seen from X_WC. Depths are weighted by their inverse variance. The result does
  /// not depend on the number of threads. Returns kInvalidArgument if the frame's size differs from
  /// the lens's, and kResourceExhausted if more blocks than allowed are needed.
  [[nodiscard]] Status add(const DepthFrame& frame, const Optics& optics, const DepthNoise& noise,
                           const Pose& X_WC, const Context& context);

  /// Returns the distance at a point, interpolated linearly; nullopt if a voxel around it was never
  /// seen.
  [[nodiscard]] std::optional<double> distance_mm(const Eigen::Vector3d& p_W) const;

  /// Distance and gradient at a point.
  struct Slope {
    double distance_mm = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< mm per mm
  };
  /// Returns distance and gradient at a point. The gradient is computed from points `reach_mm` away
  /// along the axes. Returns nullopt if any of the points was never seen or lies beyond the
  /// truncation.
  [[nodiscard]] std::optional<Slope> slope(const Eigen::Vector3d& p_W, double reach_mm) const;

  /// Returns the points that a camera at X_WV would see, in that camera's frame V.
  [[nodiscard]] Result<PointGrid> look(const Optics& optics, const Pose& X_WV,
                                       const Context& context) const;

  /// Extracts the surface in the volume (marching tetrahedra, Doi and Koide 1991).
  /// @param least_weight  minimum weight of the voxels used: sum of inverse variances, 1/mm²
  [[nodiscard]] TriangleMesh surface(double least_weight = 0) const;

  [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }

 private:
  static constexpr int kSide = 8;
  struct Voxel {
    float distance = 1;  ///< distance in units of the truncation
    float weight = 0;    ///< 0: never seen
  };
  using Block = std::array<Voxel, kSide * kSide * kSide>;

  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3d& p_W) const;
  [[nodiscard]] Eigen::Vector3d centre(const Eigen::Vector3i& cell) const;
  [[nodiscard]] bool contains(const Eigen::Vector3i& block) const;
  [[nodiscard]] std::size_t place_in_table(const Eigen::Vector3i& block) const;
  [[nodiscard]] const Block* block_of(const Eigen::Vector3i& cell) const;
  [[nodiscard]] const Voxel* voxel(const Eigen::Vector3i& cell) const;
  [[nodiscard]] std::optional<double> first_hit_mm(const Eigen::Vector3d& from,
                                                   const Eigen::Vector3d& along) const;
  Status mark_surface(const DepthFrame& frame, const Optics& optics, const Pose& X_WC,
                      std::vector<char>& marked);
  void mark_before_surface(const DepthFrame& frame, const Optics& optics, const Pose& X_CW,
                           std::vector<char>& marked) const;
  void add_to(std::size_t block, const DepthFrame& frame, const Lens& lens, const DepthNoise& noise,
              const Pose& X_CW);

  Options options_;
  Eigen::Vector3d origin_mm_;
  Eigen::Vector3i count_;            ///< number of block positions along each axis
  std::vector<std::int32_t> table_;  ///< for each position, the index of its block; -1: no block
  std::vector<Eigen::Vector3i> places_;
  std::deque<Block> blocks_;
};

}  // namespace hydroprint::scan
