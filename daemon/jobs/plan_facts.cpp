#include "daemon/jobs/plan_facts.h"

#include "daemon/jobs/calibration_binding.h"
#include "daemon/jobs/referenced_job.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/to_proto.h"

namespace hydroprint::daemon {
namespace {

constexpr int kPage = 500;

/// Returns the jobs newer than the plan that may belong to it, newest first.
Result<std::vector<v1::Job>> later_jobs(const Job& plan, const std::string& caller,
                                        JobStore& jobs) {
  std::vector<v1::Job> out;
  JobFilter filter;
  filter.limit = kPage;
  for (;;) {
    HP_ASSIGN_OR_RETURN(const std::vector<Job> page, jobs.list(filter));
    for (const Job& job : page) {
      if (job.id <= plan.id) return out;
      const std::string& owner = job.definition.owner;
      const bool is_device = !job.definition.traits.computed;
      if (is_device || owner == plan.definition.owner || owner == caller)
        out.push_back(to_message(job));
    }
    if (page.size() < kPage) return out;
    filter.before_id = page.back().id;
  }
}

/// Adds the calibration and the warnings of a simulate job.
Status add_film(const v1::Job& job, const JobSources& sources, PlanFacts& facts) {
  const std::string& name = job.simulate().calibration();
  if (!name.empty() && !facts.calibrations.contains(name)) {
    const auto found = find_calibration(name, sources.calibrations);
    if (found) facts.calibrations[name] = to_message(*found, sources.place);
    if (!found && found.error().reason != ErrorReason::CALIBRATION_NOT_FOUND)
      return tl::unexpected(found.error());
  }
  if (job.state() != v1::Job::SUCCEEDED) return {};
  HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(job.name()));
  HP_ASSIGN_OR_RETURN(const Job simulation, sources.jobs.get(id));
  const auto report = report_of(simulation, sources.jobs, sources.layout);
  if (report) facts.warnings[job.name()] = plan_warnings(report->simulate());
  return {};
}

}  // namespace

Result<PlanFacts> plan_facts(const std::string& plan_job, const std::string& caller,
                             const JobSources& sources) {
  PlanFacts out;
  HP_ASSIGN_OR_RETURN(out.spec, earlier_plan(plan_job, "name", sources.jobs));
  HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(plan_job));
  HP_ASSIGN_OR_RETURN(const Job plan, sources.jobs.get(id));
  out.plan_job = job_name(id);
  out.owners = {plan.definition.owner, caller};
  out.has_camera = !sources.camera.device.empty();
  HP_ASSIGN_OR_RETURN(out.jobs, later_jobs(plan, caller, sources.jobs));
  HP_ASSIGN_OR_RETURN(const auto active, sources.calibrations.active(CalibrationKind::kObject));
  if (active) out.active = to_message(*active, sources.place);
  for (const v1::Job& job : out.jobs) {
    if (!job.has_simulate() || job.simulate().plan_job() != out.plan_job) continue;
    HP_RETURN_IF_ERROR(add_film(job, sources, out));
  }
  return out;
}

}  // namespace hydroprint::daemon
