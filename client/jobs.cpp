#include "client/jobs.h"

#include <chrono>
#include <utility>

#include "client/connection/rpc.h"
#include "client/uuid.h"

namespace hydroprint::client {
namespace {

using JobStub = v1::JobService::Stub;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kReconnectTimeout{60};

v1::CreateJobRequest creation(v1::Job job, const JobOptions& options) {
  v1::CreateJobRequest request;
  *request.mutable_job() = std::move(job);
  request.mutable_job()->set_display_name(options.display_name);
  request.mutable_job()->set_priority(options.priority);
  request.set_request_id(make_uuid());
  request.set_validate_only(options.validate_only);
  return request;
}

// Follows one job and opens a new stream when one ends.
class Watcher {
 public:
  Watcher(Connection& connection, const std::string& name,
          const std::function<void(const v1::WatchJobResponse&)>& update)
      : connection_(connection), update_(update) {
    request_.set_name(name);
  }

  Result<v1::Job> run(const std::function<void(const Error&)>& lost) {
    wait_for_connection(connection_, kConnectLimit);
    for (;;) {
      const grpc::Status status = follow();
      if (is_finished(last_)) return last_;
      // A daemon that shuts down ends the stream with OK.
      const Error error = status.ok()
                              ? Error{Code::kUnavailable, "the daemon closed the stream", {}}
                              : to_error(connection_, status);
      if (error.reason == ErrorReason::EVENTS_GONE && request_.has_after_seq()) {
        request_.clear_after_seq();
        continue;
      }
      const bool never_answered = last_.name().empty();
      if (error.code != Code::kUnavailable || never_answered ||
          Clock::now() - last_message_time_ > kReconnectTimeout)
        return tl::unexpected(error);
      if (lost && !is_loss_reported_) lost(error);
      is_loss_reported_ = true;
      pause(connection_, kTryAgainAfter);
    }
  }

 private:
  // Reads one stream to its end.
  grpc::Status follow() {
    Call call(connection_);
    auto stream = connection_.impl().jobs->WatchJob(call.context(), request_);
    v1::WatchJobResponse message;
    while (stream->Read(&message)) take(message);
    return stream->Finish();
  }

  void take(const v1::WatchJobResponse& message) {
    request_.set_after_seq(message.seq());
    last_message_time_ = Clock::now();
    is_loss_reported_ = false;
    if (message.has_job()) last_ = message.job();
    update_(message);
  }

  Connection& connection_;
  const std::function<void(const v1::WatchJobResponse&)>& update_;
  v1::WatchJobRequest request_;
  v1::Job last_;
  Clock::time_point last_message_time_ = Clock::now();
  bool is_loss_reported_ = false;
};

}  // namespace

Result<v1::Job> create_job(Connection& connection, v1::Job job, const JobOptions& options) {
  return call(connection, *connection.impl().jobs, &JobStub::CreateJob,
              creation(std::move(job), options));
}

Result<v1::Job> create_dip(Connection& connection, const v1::DipSpec& spec,
                           const std::string& lease_id, const JobOptions& options) {
  v1::Job job;
  *job.mutable_dip() = spec;
  v1::CreateJobRequest request = creation(std::move(job), options);
  request.set_lease_id(lease_id);
  return call_once(connection, *connection.impl().jobs, &JobStub::CreateJob, request);
}

Result<v1::Job> confirm_step(Connection& connection, const std::string& name,
                             v1::DipStatus::Step step, const std::string& lease_id) {
  auto request = named<v1::ConfirmStepRequest>(name);
  request.set_step(step);
  request.set_lease_id(lease_id);
  return call_once(connection, *connection.impl().jobs, &JobStub::ConfirmStep, request);
}

Result<v1::Job> create_print(Connection& connection, const std::string& print_image_job,
                             const JobOptions& options) {
  v1::Job job;
  job.mutable_print()->set_print_image_job(print_image_job);
  return create_job(connection, std::move(job), options);
}

Result<v1::Job> create_capture(Connection& connection, std::optional<double> seconds,
                               const JobOptions& options) {
  v1::Job job;
  v1::CaptureSpec& spec = *job.mutable_capture();
  if (seconds) spec.set_seconds(*seconds);
  return create_job(connection, std::move(job), options);
}

Result<v1::Job> get_job(Connection& connection, const std::string& name) {
  return call(connection, *connection.impl().jobs, &JobStub::GetJob,
              named<v1::GetJobRequest>(name));
}

Result<v1::ListJobsResponse> list_jobs(Connection& connection, const JobFilter& filter) {
  v1::ListJobsRequest request;
  request.set_owner(filter.owner);
  for (const v1::Job::State state : filter.states) request.add_states(state);
  return all_pages(connection, *connection.impl().jobs, &JobStub::ListJobs, request,
                   &v1::ListJobsResponse::jobs_size, filter.limit);
}

Result<v1::Job> cancel_job(Connection& connection, const std::string& name) {
  return call(connection, *connection.impl().jobs, &JobStub::CancelJob,
              named<v1::CancelJobRequest>(name));
}

Result<v1::Job> retry_job(Connection& connection, const std::string& name) {
  auto request = named<v1::RetryJobRequest>(name);
  request.set_request_id(make_uuid());
  return call(connection, *connection.impl().jobs, &JobStub::RetryJob, request);
}

Result<v1::Job> pin_job(Connection& connection, const std::string& name, bool pinned) {
  auto request = named<v1::PinJobRequest>(name);
  request.set_pinned(pinned);
  return call(connection, *connection.impl().jobs, &JobStub::PinJob, request);
}

Status delete_job(Connection& connection, const std::string& name) {
  HP_RETURN_IF_ERROR(call(connection, *connection.impl().jobs, &JobStub::DeleteJob,
                          named<v1::DeleteJobRequest>(name)));
  return {};
}

Result<v1::ListJobEventsResponse> list_job_events(Connection& connection, const std::string& name) {
  v1::ListJobEventsRequest request;
  request.set_parent(name);
  return all_pages(connection, *connection.impl().jobs, &JobStub::ListJobEvents, request,
                   &v1::ListJobEventsResponse::events_size);
}

Result<v1::PlanProgress> plan_progress(Connection& connection, const std::string& plan_job) {
  return call(connection, *connection.impl().jobs, &JobStub::GetPlanProgress,
              named<v1::GetPlanProgressRequest>(plan_job));
}

Result<v1::JobReport> job_report(Connection& connection, const std::string& name) {
  return call(connection, *connection.impl().jobs, &JobStub::GetJobReport,
              named<v1::GetJobReportRequest>(name));
}

Result<v1::Job> watch_job(Connection& connection, const std::string& name,
                          const std::function<void(const v1::WatchJobResponse&)>& update,
                          const std::function<void(const Error&)>& lost) {
  return Watcher(connection, name, update).run(lost);
}

}  // namespace hydroprint::client
