#include "client/cli/job_io/dip_record.h"

#include <fmt/format.h>

namespace hydroprint::cli {

Result<std::vector<Downloaded>> fetch_record(client::Connection& daemon, const std::string& job,
                                             const std::filesystem::path& folder) {
  HP_ASSIGN_OR_RETURN(const auto artifacts, client::list_artifacts(daemon, job));
  if (artifacts.artifacts().empty()) return std::vector<Downloaded>();
  return download_all(daemon, job, {}, folder);
}

std::string dip_summary(const std::string& job, const v1::DipReport& report) {
  std::string out = job + ": dipped";
  if (report.has_depth_reached_mm())
    out += fmt::format(" {:.2f} mm deep", report.depth_reached_mm());
  if (!report.has_descent()) return out;
  const v1::DipReport::Descent& descent = report.descent();
  return out +
         fmt::format(
             " at {:.2f} mm/s, constant within {:.2f} % and {:.2f} mm (uncertainty {:.2f} mm)",
             descent.speed_mm_per_s(), 100 * descent.largest_deviation_share(),
             descent.largest_deviation_mm(), descent.deviation_uncertainty_mm());
}

}  // namespace hydroprint::cli
