#include "daemon/jobs/referenced_job.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/job.pb.h"
#include "sim/base/input_file.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kLargestReport = 4 << 20;
constexpr std::size_t kMostWarnings = 10;

}  // namespace

Result<Job> earlier_job(const std::string& name, const std::string& kind, const std::string& field,
                        JobStore& jobs) {
  HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(name));
  HP_ASSIGN_OR_RETURN(Job job, jobs.get(id));
  if (job.definition.work.verb != kind) {
    return invalid_field(
        field, fmt::format("names a {} job; name a {} job", job.definition.work.verb, kind));
  }
  if (job.state == JobState::kSucceeded) return job;
  return tl::unexpected(
      Error{Code::kFailedPrecondition,
            fmt::format("{} is {}; name a job that SUCCEEDED", name, name_of(job.state)),
            "STATE_FORBIDS",
            {{"state", name_of(job.state)}}});
}

Result<EarlierSimulation> earlier_simulation(const std::string& name, const std::string& field,
                                             JobStore& jobs) {
  EarlierSimulation out;
  HP_ASSIGN_OR_RETURN(out.job, earlier_job(name, "simulate", field, jobs));
  v1::Job body;
  if (!body.ParseFromString(out.job.definition.body) || !body.has_simulate()) {
    return fail(Code::kInternal, name + ": its spec cannot be read", "STORE_FAILED");
  }
  out.spec = body.simulate();
  return out;
}

Result<v1::PlanSpec> earlier_plan(const std::string& name, const std::string& field,
                                  JobStore& jobs) {
  HP_ASSIGN_OR_RETURN(const Job job, earlier_job(name, "plan", field, jobs));
  v1::Job body;
  if (!body.ParseFromString(job.definition.body) || !body.has_plan()) {
    return fail(Code::kInternal, name + ": its spec cannot be read", "STORE_FAILED");
  }
  return body.plan();
}

Result<std::string> report_of(const Job& job, const Layout& layout) {
  auto report = read_text_file(layout.artifacts(job.id) / "report.json", kLargestReport);
  if (report) return report;
  return fail(Code::kFailedPrecondition,
              job_name(job.id) + " has no usable report.json; retry that job", "STATE_FORBIDS");
}

Warnings report_warnings(const std::string& report, std::string_view prefix) {
  using Json = nlohmann::json;
  const Json json = Json::parse(report, nullptr, false);
  Warnings out;
  if (!json.is_object() || !json.contains("warnings")) return out;
  const auto text = [](const Json& warning, const char* key) {
    const bool is_text = warning.contains(key) && warning[key].is_string();
    return is_text ? warning[key].get<std::string>() : std::string();
  };
  for (const Json& warning : json["warnings"]) {
    if (!warning.is_object() || out.size() == kMostWarnings) continue;
    if (!text(warning, "code").starts_with(prefix)) continue;
    out.push_back({text(warning, "code"), text(warning, "message"), text(warning, "where")});
  }
  return out;
}

}  // namespace hydroprint::daemon
