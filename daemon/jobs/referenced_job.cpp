#include "daemon/jobs/referenced_job.h"

#include <fmt/format.h>

#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/job.pb.h"
#include "sim/base/input_file.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kLargestReport = 4 << 20;

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

Result<std::string> report_of(const Job& job, const Layout& layout) {
  auto report = read_text_file(layout.artifacts(job.id) / "report.json", kLargestReport);
  if (report) return report;
  return fail(Code::kFailedPrecondition,
              job_name(job.id) + " has no usable report.json; retry that job", "STATE_FORBIDS");
}

}  // namespace hydroprint::daemon
