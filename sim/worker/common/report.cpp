#include "sim/worker/common/report.h"

#include <sys/resource.h>

#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

Json inputs_json(const std::vector<Input>& inputs) {
  Json out = Json::array();
  for (const Input& input : inputs) {
    out.push_back({{"role", input.file.role},
                   {"path", input.file.path.string()},
                   {"sha256", input.digest.sha256},
                   {"size_bytes", input.digest.size_bytes}});
  }
  return out;
}

Json seconds_json(const std::vector<std::pair<std::string, double>>& seconds) {
  Json out = Json::object();
  for (const auto& [stage, value] : seconds) out[stage] = value;
  return out;
}

std::string dump(const Json& json, int indent) {
  // JSON must be UTF-8, but file names may contain other bytes.
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

Status add_inputs(Report& report, const std::vector<InputPath>& files) {
  for (const InputPath& file : files) {
    if (file.path.empty()) continue;
    HP_ASSIGN_OR_RETURN(FileDigest digest, digest_file(file.path));
    report.inputs.push_back({file, std::move(digest)});
  }
  return {};
}

std::int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

std::string report_json(const std::string& verb, const Json& findings, const Report& report) {
  Json out = {{"program", "hydroprint-worker"},
              {"version", HYDROPRINT_VERSION},
              {"verb", verb},
              {"inputs", inputs_json(report.inputs)}};
  out.update(findings);
  out.update({{"stage_seconds", seconds_json(report.stage_seconds)},
              {"total_seconds", report.total_s},
              {"peak_memory_bytes", peak_memory_bytes()},
              {"warnings", warnings_json(report.warnings)},
              {"artifacts", report.artifacts}});
  return dump(out, 2);
}

std::string summary_json(const std::filesystem::path& dir, const Json& figures,
                         const Report& report) {
  Json out = {{"out", dir.string()}, {"artifacts", report.artifacts}};
  out.update(figures);
  out.update({{"seconds", report.total_s}, {"warnings", warnings_json(report.warnings)}});
  return dump(out, -1);
}

std::string artifacts_line(const std::filesystem::path& dir, const Report& report) {
  std::string files;
  for (const std::string& name : report.artifacts) files += name + " ";
  return dir.string() + ": " + files + "report.json\n";
}

}  // namespace hydroprint::worker
