#include "sim/registration/camera/calibration_board.h"

#include <numbers>
#include <utility>

#include "sim/registration/film_frame/markers.h"
#include "sim/registration/shape.h"

namespace hydroprint::registration {
namespace {

constexpr double kWidth_mm = 140, kHeight_mm = 210;  ///< size of one plate
constexpr double kPitch_mm = 66, kPyramid_mm = 44, kTall_mm = 25;
constexpr int kColumns = 2, kRows = 3;
constexpr double kSlope_rad = std::numbers::pi / 6;

/// Returns a rectangle in z = 0 whose normal points up.
mesh::Surface rectangle(double x0, double y0, double x1, double y1) {
  mesh::Surface out;
  out.points = {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
  out.triangles = {{0, 1, 2}, {0, 2, 3}};
  out.weld = {0, 1, 2, 3};
  out.source_triangle = {0, 1};
  out.source_barycentric.assign(
      2, {Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY(), Eigen::Vector3f::UnitZ()});
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  out.corner_normals.assign(2, {up, up, up});
  return out;
}

double row_at(int row) { return kPitch_mm * (row - (kRows - 1) / 2.0); }

/// Returns the pyramids of one row with the plate between them. The plate is open below the
/// pyramids, because it is not visible there and must not be paired with scan points.
mesh::Surface row_of(int row, int columns) {
  const double y = row_at(row), y0 = y - kPyramid_mm / 2, y1 = y + kPyramid_mm / 2;
  mesh::Surface out;
  double left = 0;
  for (int column = 0; column < columns; ++column) {
    const double x = kPitch_mm * (column + 0.5);
    out = joined(std::move(out), rectangle(left, y0, x - kPyramid_mm / 2, y1));
    left = x + kPyramid_mm / 2;
    const Pose at(Eigen::Translation3d(x, y, 0));
    out = joined(std::move(out), moved(pyramid(kPyramid_mm, kTall_mm), at));
  }
  return joined(std::move(out), rectangle(left, y0, kWidth_mm, y1));
}

/// Returns a flat plate, with the ridge along y.
mesh::Surface plate(bool is_whole) {
  mesh::Surface out;
  double below = -kHeight_mm / 2;
  for (int row = 0; row < kRows; ++row) {
    const double low = row_at(row) - kPyramid_mm / 2;
    const bool lacks_one = !is_whole && row == kRows - 1;
    out = joined(std::move(out), rectangle(0, below, kWidth_mm, low));
    out = joined(std::move(out), row_of(row, lacks_one ? kColumns - 1 : kColumns));
    below = low + kPyramid_mm;
  }
  return joined(std::move(out), rectangle(0, below, kWidth_mm, kHeight_mm / 2));
}

}  // namespace

mesh::Surface calibration_board() {
  const Pose down(Eigen::AngleAxisd(kSlope_rad, Eigen::Vector3d::UnitY()));
  const Pose across(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()));
  return joined(moved(plate(false), down), moved(plate(true), across * down));
}

}  // namespace hydroprint::registration
