#include "client/cli/job_io/dip_record.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

// Returns for example ", 20.00 mm deep"; empty if the report lacks the number.
std::string told(const nlohmann::json& report, const char* pointer, const std::string& before,
                 const std::string& after, double scale = 1) {
  const nlohmann::json::json_pointer path(pointer);
  if (!report.contains(path) || !report.at(path).is_number()) return "";
  return before + format_fixed(scale * report.at(path).get<double>()) + after;
}

nlohmann::json read_report(const std::vector<Downloaded>& files) {
  for (const Downloaded& file : files) {
    if (client::file_name(file.artifact) != "report.json") continue;
    auto report = nlohmann::json::parse(std::ifstream(file.path), nullptr, false);
    if (report.is_object()) return report;
  }
  return nlohmann::json::object();
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
  return job.name() + ": dipped" + told(report, "/depth_reached_mm", " ", " mm deep") +
         told(report, "/descent/speed_mm_per_s", " at ", " mm/s") +
         told(report, "/descent/largest_deviation_share", ", constant within ", " %", 100) +
         told(report, "/descent/largest_deviation_mm", " and ", " mm") +
         told(report, "/descent/deviation_uncertainty_mm", " (uncertainty ", " mm)");
}

}  // namespace hydroprint::cli
