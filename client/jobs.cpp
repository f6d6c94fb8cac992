#include "client/jobs.h"

#include <chrono>
#include <utility>

#include "client/connection/rpc.h"
#include "client/convert.h"
#include "client/uuid.h"

namespace hydroprint::client {
namespace {

using JobStub = v1::JobService::Stub;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kGiveUpAfter{60};

Result<Job> to_job(Result<v1::Job> answer) {
  return std::move(answer).map([](const v1::Job& job) { return from_proto(job); });
}

template <class Request>
Request named(const std::string& name) {
  Request request;
  request.set_name(name);
  return request;
}

v1::CreateJobRequest creation(const JobOptions& options) {
  v1::CreateJobRequest request;
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
          const std::function<void(const JobUpdate&)>& update)
      : connection_(connection), update_(update) {
    request_.set_name(name);
  }

  Result<Job> run(const std::function<void(const Error&)>& lost) {
    wait_for_connection(connection_, kConnectLimit);
    for (;;) {
      const grpc::Status status = follow();
      if (is_finished(last_)) return last_;
      // A daemon that shuts down ends the stream with OK.
      const Error error = status.ok()
                              ? Error{Code::kUnavailable, "the daemon closed the stream", {}}
                              : to_error(connection_, status);
      if (error.reason == "EVENTS_GONE" && request_.has_after_seq()) {
        request_.clear_after_seq();
        continue;
      }
      const bool never_answered = last_.name.empty();
      if (error.code != Code::kUnavailable || never_answered ||
          Clock::now() - last_news_ > kGiveUpAfter)
        return tl::unexpected(error);
      if (lost && !told_) lost(error);
      told_ = true;
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
    last_news_ = Clock::now();
    told_ = false;
    JobUpdate update;
    if (message.has_job()) update.job = last_ = from_proto(message.job());
    if (message.has_event()) update.event = from_proto(message.event());
    update_(update);
  }

  Connection& connection_;
  const std::function<void(const JobUpdate&)>& update_;
  v1::WatchJobRequest request_;
  Job last_;
  Clock::time_point last_news_ = Clock::now();
  bool told_ = false;
};

}  // namespace

Result<Job> create_job(Connection& connection, const Spec& spec, const JobOptions& options) {
  v1::CreateJobRequest request = creation(options);
  HP_RETURN_IF_ERROR(to_proto(spec, *request.mutable_job()));
  return to_job(call(connection, *connection.impl().jobs, &JobStub::CreateJob, request));
}

Result<Job> create_dip(Connection& connection, const DipSpec& spec, const std::string& lease_id,
                       const JobOptions& options) {
  v1::CreateJobRequest request = creation(options);
  *request.mutable_job()->mutable_dip() = to_proto(spec);
  request.set_lease_id(lease_id);
  return to_job(call_once(connection, *connection.impl().jobs, &JobStub::CreateJob, request));
}

Result<Job> confirm_step(Connection& connection, const std::string& name, DipStep step,
                         const std::string& lease_id) {
  auto request = named<v1::ConfirmStepRequest>(name);
  request.set_step(to_proto(step));
  request.set_lease_id(lease_id);
  return to_job(call_once(connection, *connection.impl().jobs, &JobStub::ConfirmStep, request));
}

Result<Job> create_print(Connection& connection, const std::string& print_image_job,
                         const JobOptions& options) {
  v1::CreateJobRequest request = creation(options);
  request.mutable_job()->mutable_print()->set_print_image_job(print_image_job);
  return to_job(call(connection, *connection.impl().jobs, &JobStub::CreateJob, request));
}

Result<Job> create_capture(Connection& connection, std::optional<double> seconds,
                           const JobOptions& options) {
  v1::CreateJobRequest request = creation(options);
  v1::CaptureSpec& spec = *request.mutable_job()->mutable_capture();
  if (seconds) spec.set_seconds(*seconds);
  return to_job(call(connection, *connection.impl().jobs, &JobStub::CreateJob, request));
}

Result<Job> get_job(Connection& connection, const std::string& name) {
  return to_job(
      call(connection, *connection.impl().jobs, &JobStub::GetJob, named<v1::GetJobRequest>(name)));
}

Result<std::vector<Job>> list_jobs(Connection& connection, const JobFilter& filter) {
  v1::ListJobsRequest request;
  request.set_owner(filter.owner);
  for (const JobState state : filter.states) request.add_states(to_proto(state));
  std::vector<Job> jobs;
  do {
    request.set_page_size(filter.limit - static_cast<int>(jobs.size()));
    HP_ASSIGN_OR_RETURN(const auto page,
                        call(connection, *connection.impl().jobs, &JobStub::ListJobs, request));
    for (const auto& job : page.jobs()) jobs.push_back(from_proto(job));
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty() && std::ssize(jobs) < filter.limit);
  return jobs;
}

Result<Job> cancel_job(Connection& connection, const std::string& name) {
  return to_job(call(connection, *connection.impl().jobs, &JobStub::CancelJob,
                     named<v1::CancelJobRequest>(name)));
}

Result<Job> retry_job(Connection& connection, const std::string& name) {
  auto request = named<v1::RetryJobRequest>(name);
  request.set_request_id(make_uuid());
  return to_job(call(connection, *connection.impl().jobs, &JobStub::RetryJob, request));
}

Result<Job> pin_job(Connection& connection, const std::string& name, bool pinned) {
  auto request = named<v1::PinJobRequest>(name);
  request.set_pinned(pinned);
  return to_job(call(connection, *connection.impl().jobs, &JobStub::PinJob, request));
}

Status delete_job(Connection& connection, const std::string& name) {
  HP_RETURN_IF_ERROR(call(connection, *connection.impl().jobs, &JobStub::DeleteJob,
                          named<v1::DeleteJobRequest>(name)));
  return {};
}

Result<std::vector<JobEvent>> list_job_events(Connection& connection, const std::string& name) {
  v1::ListJobEventsRequest request;
  request.set_parent(name);
  request.set_page_size(1000);
  std::vector<JobEvent> events;
  do {
    HP_ASSIGN_OR_RETURN(const auto page, call(connection, *connection.impl().jobs,
                                              &JobStub::ListJobEvents, request));
    for (const auto& event : page.events()) events.push_back(from_proto(event));
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  return events;
}

Result<Job> watch_job(Connection& connection, const std::string& name,
                      const std::function<void(const JobUpdate&)>& update,
                      const std::function<void(const Error&)>& lost) {
  return Watcher(connection, name, update).run(lost);
}

}  // namespace hydroprint::client
