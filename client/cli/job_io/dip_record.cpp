#include "client/cli/job_io/dip_record.h"

#include "client/cli/terminal/console.h"
#include "sim/base/checked_json.h"

namespace hydroprint::cli {
namespace {

// Returns for example ", 20.00 mm deep"; empty if the report lacks the number.
std::string figure_text(const nlohmann::json& report, const char* key, const std::string& before,
                        const std::string& after, double scale = 1) {
  const auto number = json_number(report, key);
  return number ? before + format_fixed(scale * *number) + after : "";
}

nlohmann::json read_report(const std::vector<Downloaded>& files) {
  for (const Downloaded& file : files) {
    if (client::file_name(file.artifact) == "report.json")
      return read_json_file(file.path).value_or(nullptr);
  }
  return nullptr;
}

}  // namespace

Result<std::vector<Downloaded>> fetch_record(client::Connection& daemon, const std::string& job,
                                             const std::filesystem::path& folder) {
  HP_ASSIGN_OR_RETURN(const auto artifacts, client::list_artifacts(daemon, job));
  if (artifacts.artifacts().empty()) return std::vector<Downloaded>();
  return download_all(daemon, job, {}, folder);
}

std::string dip_summary(const v1::Job& job, const std::vector<Downloaded>& files) {
  const nlohmann::json report = read_report(files);
  const nlohmann::json& descent = json_at(report, "descent");
  return job.name() + ": dipped" + figure_text(report, "depth_reached_mm", " ", " mm deep") +
         figure_text(descent, "speed_mm_per_s", " at ", " mm/s") +
         figure_text(descent, "largest_deviation_share", ", constant within ", " %", 100) +
         figure_text(descent, "largest_deviation_mm", " and ", " mm") +
         figure_text(descent, "deviation_uncertainty_mm", " (uncertainty ", " mm)");
}

}  // namespace hydroprint::cli
