#include "daemon/earlier_job.h"

#include "daemon/names.h"
#include "sim/base/input_file.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kLargestReport = 4 << 20;

}  // namespace

Result<Job> earlier_job(const std::string& name, const std::string& verb, const std::string& field,
                        JobStore& jobs) {
  HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(name));
  HP_ASSIGN_OR_RETURN(Job job, jobs.get(id));
  if (job.made.work.verb != verb) {
    return invalid_field(field, "names a " + job.made.work.verb + " job; name a " + verb + " job");
  }
  if (job.state == JobState::kSucceeded) return job;
  return tl::unexpected(Error{Code::kFailedPrecondition,
                              name + " is " + name_of(job.state) + "; name a job that SUCCEEDED",
                              "STATE_FORBIDS",
                              {{"state", name_of(job.state)}}});
}

Result<std::string> report_of(const Job& job, const Layout& layout) {
  auto report = read_text_file(layout.artifacts(job.id) / "report.json", kLargestReport);
  if (report) return report;
  return fail(Code::kFailedPrecondition, job_name(job.id) + " has no usable report.json; retry it",
              "STATE_FORBIDS");
}

}  // namespace hydroprint::daemon
