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

/// Truncated signed distances to what was seen, positive before a surface, on a grid that exists in
/// blocks where surfaces are (Curless and Levoy 1996; Izadi et al. 2011, section 3). Frame W.
class Volume {
 public:
  struct Options {
    double voxel_mm = 3;
    double truncation_mm = 12;        ///< some eight standard deviations of the depth at 0.8 m
    std::size_t most_blocks = 60000;  ///< of 4 KiB
  };

  /// @param box_mm  beyond which nothing is kept
  Volume(const Eigen::AlignedBox3d& box_mm, const Options& options);

  /// Takes in a frame seen from X_WC; every depth counts by its inverse variance.
  /// Refuses (kInvalidArgument) a frame that is not of the lens's size, (kResourceExhausted) more
  /// blocks than allowed. The same volume whatever the number of threads.
  [[nodiscard]] Status add(const DepthFrame& frame, const Optics& optics, const DepthNoise& noise,
                           const Pose& X_WC, const Context& context);

  /// Distance at a point, between voxels linear; none where a voxel around it was never seen.
  [[nodiscard]] std::optional<double> distance_mm(const Eigen::Vector3d& p_W) const;

  /// The distance at a point, and how it grows about it.
  struct Slope {
    double distance_mm = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< mm per mm
  };
  /// None where the point or one of those `reach_mm` from it along the axes, which the gradient is
  /// taken from, was never seen or lies beyond the truncation.
  [[nodiscard]] std::optional<Slope> slope(const Eigen::Vector3d& p_W, double reach_mm) const;

  /// What a camera there would see, in its own frame.
  [[nodiscard]] Result<PointGrid> look(const Optics& optics, const Pose& X_WV,
                                       const Context& context) const;

  /// The surface of what was seen (marching tetrahedra, Doi and Koide 1991).
  /// @param least_weight  of what is trusted: sum of inverse variances, 1/mm²
  [[nodiscard]] TriangleMesh surface(double least_weight = 0) const;

  [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }

 private:
  static constexpr int kSide = 8;
  struct Voxel {
    float distance = 1;  ///< in truncations
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
  Eigen::Vector3i count_;            ///< of blocks along each axis
  std::vector<std::int32_t> table_;  ///< per place of a block: which; -1: none
  std::vector<Eigen::Vector3i> places_;
  std::deque<Block> blocks_;
};

}  // namespace hydroprint::scan
