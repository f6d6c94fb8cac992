#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/job.h"
#include "hydroprint/v1/job_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Options of a new job.
struct JobOptions {
  std::string display_name;    ///< empty: chosen by the daemon
  int priority = 0;            ///< 0 to 9; among one owner's jobs, higher runs first
  bool validate_only = false;  ///< only checks; the returned job has no name
};

/// Queues a job.
/// @param job  its spec; display name and priority are taken from `options`
/// @return errors: see JobService.CreateJob
[[nodiscard]] Result<v1::Job> create_job(Connection& connection, v1::Job job,
                                         const JobOptions& options = {});

/// Creates a dip job, which waits for the operator immediately (WAITING_FOR_OPERATOR). The request
/// is sent once, because with DipSpec.yes_to_all it moves the axis. If the response is lost
/// (kUnavailable), call list_jobs before another attempt.
/// @param lease_id  the caller's lease of the rig
[[nodiscard]] Result<v1::Job> create_dip(Connection& connection, const v1::DipSpec& spec,
                                         const std::string& lease_id,
                                         const JobOptions& options = {});

/// Confirms that the operator has completed the current step. The request is sent once, because the
/// rig may move next. If the response is lost, call get_job.
[[nodiscard]] Result<v1::Job> confirm_step(Connection& connection, const std::string& name,
                                           v1::DipStatus::Step step, const std::string& lease_id);

/// Prints the pages of a print-image job on the daemon's printer. Errors: PRINTER_MISSING,
/// STATE_FORBIDS. A failure of the printer is reported by the job itself.
[[nodiscard]] Result<v1::Job> create_print(Connection& connection,
                                           const std::string& print_image_job,
                                           const JobOptions& options = {});

/// Records frames of the daemon's camera immediately. Errors: CAMERA_MISSING, STATE_FORBIDS,
/// MOTION_IN_PROGRESS.
/// @param seconds  nullopt: the daemon's default
[[nodiscard]] Result<v1::Job> create_capture(Connection& connection, std::optional<double> seconds,
                                             const JobOptions& options = {});

[[nodiscard]] Result<v1::Job> get_job(Connection& connection, const std::string& name);

/// Selects the jobs to list.
struct JobFilter {
  std::vector<v1::Job::State> states;  ///< empty: all
  std::string owner;                   ///< empty: all
  int limit = 50;                      ///< maximum number of jobs
};

/// Lists jobs, newest first.
[[nodiscard]] Result<v1::ListJobsResponse> list_jobs(Connection& connection,
                                                     const JobFilter& filter);

[[nodiscard]] Result<v1::Job> cancel_job(Connection& connection, const std::string& name);

/// Queues a new job with the spec of a finished job. The daemon computes it without using cached
/// results.
[[nodiscard]] Result<v1::Job> retry_job(Connection& connection, const std::string& name);

/// Pins a job, which exempts it from retention, or unpins it.
[[nodiscard]] Result<v1::Job> pin_job(Connection& connection, const std::string& name, bool pinned);

/// Deletes a finished job with its events and artifacts.
[[nodiscard]] Status delete_job(Connection& connection, const std::string& name);

/// Returns the stored events of a job, oldest first.
[[nodiscard]] Result<v1::ListJobEventsResponse> list_job_events(Connection& connection,
                                                                const std::string& name);

/// Returns what has been done of a plan of several dips, and the next step of each dip. Errors: see
/// JobService.GetPlanProgress.
[[nodiscard]] Result<v1::PlanProgress> plan_progress(Connection& connection,
                                                     const std::string& plan_job);

/// Returns the report of a job. Errors: ARTIFACT_NOT_FOUND, ARTIFACT_DAMAGED.
[[nodiscard]] Result<v1::JobReport> job_report(Connection& connection, const std::string& name);

/// Follows a job until it is finished and reports each message of the stream. Resumes after a lost
/// connection, for up to a minute after the last message from the daemon.
/// @param lost  called once each time the connection is lost
/// @return the finished job; kCancelled if the connection is stopped (the job continues)
[[nodiscard]] Result<v1::Job> watch_job(
    Connection& connection, const std::string& name,
    const std::function<void(const v1::WatchJobResponse&)>& update,
    const std::function<void(const Error&)>& lost = {});

}  // namespace hydroprint::client
