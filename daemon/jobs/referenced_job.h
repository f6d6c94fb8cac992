#pragma once

#include <string>
#include <vector>

#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"
#include "hydroprint/v1/report.pb.h"
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

/// Returns the spec of a plan job that SUCCEEDED. Errors: those of earlier_simulation().
[[nodiscard]] Result<v1::PlanSpec> earlier_plan(const std::string& name, const std::string& field,
                                                JobStore& jobs);

/// Reads the report of a job that SUCCEEDED; see read_report().
/// @return kFailedPrecondition, STATE_FORBIDS if it is not usable
[[nodiscard]] Result<v1::JobReport> report_of(const Job& job, JobStore& jobs, const Layout& layout);

/// Returns the warnings of a simulation about a dip that differs from its plan.
[[nodiscard]] std::vector<v1::Warning> plan_warnings(const v1::SimulateReport& report);

}  // namespace hydroprint::daemon
