#include "sim/fit/points.h"

#include <algorithm>
#include <cmath>

#include "sim/base/csv_file.h"

namespace hydroprint::fit {
namespace {

constexpr double kFarthest_mm = 1e4;

}  // namespace

Result<std::vector<Point>> read_points(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const CsvTable table,
                      read_csv(path, "film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm", kMostPoints));
  std::vector<Point> points;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double* at = table.row(i);
    if (std::any_of(at, at + 5, [](double x) { return std::abs(x) > kFarthest_mm; })) {
      return fail(
          Code::kOutOfRange,
          table.place(i) + ": a coordinate exceeds 1e4 mm. Check that the coordinates are in mm");
    }
    points.push_back({{at[0], at[1]}, {at[2], at[3], at[4]}});
  }
  if (points.empty()) {
    return fail(Code::kInvalidArgument,
                path.string() + ": line 2: no points. Write one measured point per line");
  }
  return points;
}

}  // namespace hydroprint::fit
