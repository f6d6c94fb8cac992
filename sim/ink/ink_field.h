#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "sim/base/result.h"
#include "sim/film/outline.h"

namespace hydroprint::ink {

/// The largest possible amount of ink: C, M, Y and K in full (section 4.3).
inline constexpr double kMostInk = 4;

inline constexpr double kInkCell_mm = 1;

/// Equal cells that cover a film's bounding box exactly. Cell (i, j) begins at
/// low_mm + (i, j) cell_mm: row 0 is the lowest, y up.
struct InkGrid {
  Eigen::Vector2d low_mm = Eigen::Vector2d::Zero();
  Eigen::Vector2d cell_mm = Eigen::Vector2d::Ones();
  int columns = 0, rows = 0;

  [[nodiscard]] Eigen::Vector2d centre_mm(int i, int j) const {
    return low_mm + cell_mm.cwiseProduct(Eigen::Vector2d(i + 0.5, j + 0.5));
  }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(columns) * rows; }
};

/// The grid whose cells are nearest to `cell_mm`; they are wider if there would be more than 2048
/// along a side.
[[nodiscard]] InkGrid ink_grid(const film::Outline& outline, double cell_mm = kInkCell_mm);

/// The amount of ink t = C + M + Y + K on a printed film (section 4.3), in [0, 4], at printed
/// points in F. It is given as means over the cells of a grid. Between their centres it is
/// bilinear; from the outermost centres to the edge of the grid it is constant, and beyond the edge
/// it is 0. The integral over the film is therefore that of the cells.
class InkField {
 public:
  /// No ink anywhere.
  InkField() = default;

  /// @param means  of t over each cell, cell (i, j) at [j columns + i]
  /// Refuses (kInvalidArgument) a wrong number of means and values outside [0, 4].
  [[nodiscard]] static Result<InkField> from_means(const InkGrid& grid,
                                                   const std::vector<double>& means);

  /// From t as a function of the printed point (mm), as the mean of 4 x 4 points per cell. Refuses
  /// (kInvalidArgument) a function with values outside [0, 4].
  [[nodiscard]] static Result<InkField> from_function(
      const InkGrid& grid, const std::function<double(const Eigen::Vector2d&)>& t);

  /// t at a printed point.
  [[nodiscard]] double at(const Eigen::Vector2d& point_mm) const;

  /// Mean of at() over a triangle of any size and orientation, exact up to rounding. Nothing is
  /// lost or counted twice if triangles cover a film. The run time grows with the number of cells
  /// along the edges. For a triangle without area, t at its centroid; 0 if a corner is not finite.
  [[nodiscard]] double mean(const Eigen::Vector2d& a_mm, const Eigen::Vector2d& b_mm,
                            const Eigen::Vector2d& c_mm) const;

  /// Integral of t over the film, mm2.
  [[nodiscard]] double total_mm2() const;

  [[nodiscard]] const InkGrid& grid() const { return grid_; }

 private:
  // Below, coordinates are in cells, shifted by half a cell up and right: (1, 1) is the centre of
  // cell (0, 0). Nodes are at whole numbers; the outermost cells have a second node beyond the
  // edge.
  InkField(const InkGrid& grid, const std::vector<double>& means);
  [[nodiscard]] Eigen::Vector2d in_cells(const Eigen::Vector2d& point_mm) const;
  [[nodiscard]] double to_the_left(int i, int j, double u, double v) const;
  [[nodiscard]] double left_of_edge(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

  struct Node {
    double t = 0;
    double left = 0;  ///< integral of t along the row, from its first node to this one
  };

  InkGrid grid_;
  int stride_ = 0;
  std::vector<Node> nodes_;
};

}  // namespace hydroprint::ink
