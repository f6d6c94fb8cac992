#include "daemon/jobs/referenced_job.h"

#include <fmt/format.h>

#include "daemon/jobs/report.h"
#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {

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
            ErrorReason::STATE_FORBIDS,
            {{"state", name_of(job.state)}}});
}

Result<EarlierSimulation> earlier_simulation(const std::string& name, const std::string& field,
                                             JobStore& jobs) {
  EarlierSimulation out;
  HP_ASSIGN_OR_RETURN(out.job, earlier_job(name, "simulate", field, jobs));
  v1::Job body;
  if (!body.ParseFromString(out.job.definition.body) || !body.has_simulate()) {
    return fail(Code::kInternal, name + ": its spec cannot be read", ErrorReason::STORE_FAILED);
  }
  out.spec = body.simulate();
  return out;
}

Result<v1::PlanSpec> earlier_plan(const std::string& name, const std::string& field,
                                  JobStore& jobs) {
  HP_ASSIGN_OR_RETURN(const Job job, earlier_job(name, "plan", field, jobs));
  v1::Job body;
  if (!body.ParseFromString(job.definition.body) || !body.has_plan()) {
    return fail(Code::kInternal, name + ": its spec cannot be read", ErrorReason::STORE_FAILED);
  }
  return body.plan();
}

Result<v1::JobReport> report_of(const Job& job, JobStore& jobs, const Layout& layout) {
  auto report = jobs.sound_artifact(job.id, kReport).and_then([&](const Artifact&) {
    return read_report(layout.artifacts(job.id), job.definition.work.verb);
  });
  if (report) return report;
  return fail(Code::kFailedPrecondition,
              fmt::format("{} has no usable report ({}); retry that job", job_name(job.id),
                          report.error().message),
              ErrorReason::STATE_FORBIDS);
}

std::vector<v1::Warning> plan_warnings(const v1::SimulateReport& report) {
  std::vector<v1::Warning> out;
  for (const v1::Warning& warning : report.run().warnings()) {
    const v1::Warning::Code code = warning.code();
    if (code == v1::Warning::PLAN_POSE_OFF || code == v1::Warning::PLAN_REACH_LOST ||
        code == v1::Warning::PLAN_SEAM_MOVED)
      out.push_back(warning);
  }
  return out;
}

}  // namespace hydroprint::daemon
