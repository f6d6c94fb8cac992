#include "sim/worker/common/motion_file.h"

#include <string>

#include "sim/base/csv_file.h"

namespace hydroprint::worker {
namespace {

constexpr std::size_t kMaxRows = 1'000'000;
constexpr double kMaxOffset_mm = 1e4;

/// Describes why `row` cannot follow the rows of `motion`; empty if it can.
std::string objection(const waterline::Motion& motion, const waterline::Motion::Row& row) {
  if (row.offset_mm.cwiseAbs().maxCoeff() > kMaxOffset_mm || row.immersion_mm > kMaxOffset_mm) {
    return "more than 10 m from the start. Write the positions in mm";
  }
  if (motion.rows.empty()) return {};
  if (row.time_s <= motion.rows.back().time_s) {
    return "t_s does not increase. Sort the rows by time and remove repeated ones";
  }
  if (row.immersion_mm < motion.rows.back().immersion_mm) {
    return "z_mm rises. Keep only the rows of the descent";
  }
  return {};
}

}  // namespace

Result<waterline::Motion> read_motion(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const CsvTable table, read_csv(path, "t_s,x_mm,y_mm,z_mm", kMaxRows));
  waterline::Motion motion;
  const double* start = table.values.data();
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double* at = table.row(i);
    const waterline::Motion::Row row{
        at[0] - start[0], start[3] - at[3], {at[1] - start[1], at[2] - start[2]}};
    if (const std::string what = objection(motion, row); !what.empty()) {
      return fail(Code::kInvalidArgument, table.place(i) + ": " + what);
    }
    motion.rows.push_back(row);
  }
  if (motion.rows.size() < 2) {
    return fail(Code::kInvalidArgument,
                path.string() + ": fewer than two rows. Use a file with the whole descent");
  }
  return motion;
}

}  // namespace hydroprint::worker
