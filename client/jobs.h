#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/job.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// What a new job is called and how urgent it is.
struct JobOptions {
  std::string display_name;    ///< empty: the daemon finds one
  int priority = 0;            ///< 0 to 9, higher first among one owner's
  bool validate_only = false;  ///< checks only; the job that comes back has no name
};

/// Queues a job. Errors: the daemon's, as JobService.CreateJob describes them.
[[nodiscard]] Result<Job> create_job(Connection& connection, const Spec& spec,
                                     const JobOptions& options = {});

/// Creates a dip, which is WAITING_FOR_OPERATOR at once. Sent once, since with `yes_to_all` it
/// moves: if the answer is lost (kUnavailable), see list_jobs before another attempt.
/// @param lease_id  the caller's lease of the rig
[[nodiscard]] Result<Job> create_dip(Connection& connection, const DipSpec& spec,
                                     const std::string& lease_id, const JobOptions& options = {});

/// Says that the operator has done what the dip waits for. Sent once, as the rig may move next; if
/// the answer is lost, see get_job.
[[nodiscard]] Result<Job> confirm_step(Connection& connection, const std::string& name,
                                       DipStep step, const std::string& lease_id);

/// Has the daemon's printer print what a print-image job made. Errors: PRINTER_MISSING,
/// STATE_FORBIDS; what the printer does comes as the job's end.
[[nodiscard]] Result<Job> create_print(Connection& connection, const std::string& print_image_job,
                                       const JobOptions& options = {});

/// Takes frames of the daemon's camera, at once. Errors: CAMERA_MISSING, STATE_FORBIDS,
/// MOTION_IN_PROGRESS.
/// @param seconds  none: the daemon's default
[[nodiscard]] Result<Job> create_capture(Connection& connection, std::optional<double> seconds,
                                         const JobOptions& options = {});

[[nodiscard]] Result<Job> get_job(Connection& connection, const std::string& name);

/// Which jobs are listed.
struct JobFilter {
  std::vector<JobState> states;  ///< empty: all
  std::string owner;             ///< empty: all
  int limit = 50;                ///< at most so many
};

/// Jobs, newest first.
[[nodiscard]] Result<std::vector<Job>> list_jobs(Connection& connection, const JobFilter& filter);

[[nodiscard]] Result<Job> cancel_job(Connection& connection, const std::string& name);

/// Queues a new job with the spec of a finished one, computed afresh.
[[nodiscard]] Result<Job> retry_job(Connection& connection, const std::string& name);

/// Keeps a job beyond its time, or no longer.
[[nodiscard]] Result<Job> pin_job(Connection& connection, const std::string& name, bool pinned);

/// Deletes a finished job with its events and artifacts.
[[nodiscard]] Status delete_job(Connection& connection, const std::string& name);

/// The events kept of a job, oldest first.
[[nodiscard]] Result<std::vector<JobEvent>> list_job_events(Connection& connection,
                                                            const std::string& name);

/// One message of watch_job.
struct JobUpdate {
  std::optional<Job> job;         ///< first, and with every change of state
  std::optional<JobEvent> event;  ///< not in the first
};

/// Follows a job until it is finished, and tells what happens. A broken connection is taken up
/// again where it broke, for up to a minute without any news from the daemon.
/// @param lost  told once each time the connection is lost
/// @return the job as it finished; kCancelled once the connection is to stop (the job goes on)
[[nodiscard]] Result<Job> watch_job(Connection& connection, const std::string& name,
                                    const std::function<void(const JobUpdate&)>& update,
                                    const std::function<void(const Error&)>& lost = {});

}  // namespace hydroprint::client
