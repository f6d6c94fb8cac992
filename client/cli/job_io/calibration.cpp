#include "client/cli/job_io/calibration.h"

#include <iostream>

#include "client/calibration.h"
#include "client/cli/format/calibration_text.h"

namespace hydroprint::cli {
namespace {

constexpr int kNewest = 100;  // the job's calibration is among the newest ones

}  // namespace

Result<std::string> capture_frames(Program& program, std::optional<double> seconds,
                                   const WaitOptions& options) {
  HP_ASSIGN_OR_RETURN(const v1::Job job, client::create_capture(program.daemon(), seconds, {}));
  if (!program.json()) std::cout << job.name() << std::endl;
  HP_RETURN_IF_ERROR(wait_for(program, job.name(), options));
  return job.name();
}

Status run_calibration(Program& program, const v1::Job& job, const client::JobOptions& job_options,
                       const FinishOptions& options) {
  HP_ASSIGN_OR_RETURN(const v1::Job created,
                      client::create_job(program.daemon(), job, job_options));
  HP_RETURN_IF_ERROR(finish_job(program, created, options));
  if (options.no_wait || program.json()) return {};
  HP_ASSIGN_OR_RETURN(const auto list, client::list_calibrations(program.daemon(), kNewest));
  for (const v1::Calibration& calibration : list.calibrations()) {
    if (calibration.job() == created.name()) std::cout << text_of(calibration) << std::flush;
  }
  return {};
}

}  // namespace hydroprint::cli
