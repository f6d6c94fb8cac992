#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "sim/base/result.h"
#include "sim/film/outline.h"

namespace hydroprint::ink {

/// The largest possible amount of ink: full C, M, Y and K (section 4.3).
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

/// Returns the grid with cells nearest in size to `cell_mm`; they are larger if a side would have
/// more than 2048 cells.
[[nodiscard]] InkGrid ink_grid(const film::Outline& outline, double cell_mm = kInkCell_mm);

/// The amount of ink t = C + M + Y + K on a printed film (section 4.3), in [0, 4], at printed
/// points in the film frame F. It is defined by means over the cells of a grid: bilinear between
/// the cells' centres, constant from the outermost centres to the edge of the grid, and 0 beyond.
/// Its integral over the film therefore equals the sum of the means times the area of a cell.
class InkField {
 public:
  /// Creates a field without ink.
  InkField() = default;

  /// Errors: kInvalidArgument for a wrong number of means or values outside [0, 4].
  /// @param means  means of t over each cell; that of cell (i, j) is at [j columns + i]
  [[nodiscard]] static Result<InkField> from_means(const InkGrid& grid,
                                                   const std::vector<double>& means);

  /// Creates a field from t as a function of the printed point (mm), as the mean of 4 x 4 points
  /// per cell. Errors: kInvalidArgument if the function has values outside [0, 4].
  [[nodiscard]] static Result<InkField> from_function(
      const InkGrid& grid, const std::function<double(const Eigen::Vector2d&)>& t);

  /// Returns t at a printed point.
  [[nodiscard]] double at(const Eigen::Vector2d& point_mm) const;

  /// Returns the mean of at() over a triangle of any size and orientation, exact up to rounding.
  /// Triangles that tile a film therefore conserve its total ink. The run time grows with the
  /// number of cells along the edges. Returns t at the centroid if the triangle has no area, and 0
  /// if a corner is not finite.
  [[nodiscard]] double mean(const Eigen::Vector2d& a_mm, const Eigen::Vector2d& b_mm,
                            const Eigen::Vector2d& c_mm) const;

  /// Returns the integral of t over the film, mm2.
  [[nodiscard]] double total_mm2() const;

  [[nodiscard]] const InkGrid& grid() const { return grid_; }

 private:
  // The functions below use coordinates in cells, shifted by half a cell up and right: (1, 1) is
  // the centre of cell (0, 0). Nodes are at integers; the outermost cells have a second node beyond
  // the edge.
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
