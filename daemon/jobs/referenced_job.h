#pragma once

#include <string>

#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {

/// Returns the job that another job continues from.
/// @param name   "jobs/7"
/// @param kind  required kind, such as "print-image"
/// @param field  name of the spec's field that names the job, for errors
/// @return ID_INVALID, JOB_NOT_FOUND; SPEC_INVALID for a job of another kind; STATE_FORBIDS for a
///         job that did not succeed
[[nodiscard]] Result<Job> earlier_job(const std::string& name, const std::string& kind,
                                      const std::string& field, JobStore& jobs);

/// A simulate job that another job continues from, and its spec.
struct EarlierSimulation {
  Job job;
  v1::SimulateSpec spec;
};
/// Same as earlier_job() for a simulate job, but also returns its spec. Also kInternal,
/// STORE_FAILED if the spec cannot be read.
[[nodiscard]] Result<EarlierSimulation> earlier_simulation(const std::string& name,
                                                           const std::string& field,
                                                           JobStore& jobs);

/// Reads report.json of a job.
/// @return kFailedPrecondition, STATE_FORBIDS if the file is missing, unreadable or too large
[[nodiscard]] Result<std::string> report_of(const Job& job, const Layout& layout);

}  // namespace hydroprint::daemon
