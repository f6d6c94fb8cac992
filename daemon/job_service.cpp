#include "daemon/calibration_use.h"
#include "daemon/captured.h"
#include "daemon/convert.h"
#include "daemon/dip_spec.h"
#include "daemon/log.h"
#include "daemon/names.h"
#include "daemon/print_plan.h"
#include "daemon/services.h"
#include "daemon/sight.h"
#include "daemon/simulated.h"
#include "daemon/spec.h"
#include "daemon/status.h"
#include "daemon/watch.h"
#include "hydroprint/v1/job_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr int kMostWatches = 128;  // each holds a thread

class JobService final : public v1::JobService::Service {
 public:
  explicit JobService(const Backend& backend) : backend_(backend) {}

  grpc::Status CreateJob(grpc::ServerContext* context, const v1::CreateJobRequest* request,
                         v1::Job* reply) override {
    return answer(*context, create(*context, *request), reply);
  }

  grpc::Status GetJob(grpc::ServerContext* context, const v1::GetJobRequest* request,
                      v1::Job* reply) override {
    return answer(*context, get(request->name()), reply);
  }

  grpc::Status ListJobs(grpc::ServerContext* context, const v1::ListJobsRequest* request,
                        v1::ListJobsResponse* reply) override {
    return to_grpc(list(*context, *request, *reply));
  }

  grpc::Status DeleteJob(grpc::ServerContext* context, const v1::DeleteJobRequest* request,
                         google::protobuf::Empty*) override {
    const auto job = own(*context, request->name());
    return job ? to_grpc(backend_.jobs.remove(job->id)) : to_grpc(job.error());
  }

  grpc::Status CancelJob(grpc::ServerContext* context, const v1::CancelJobRequest* request,
                         v1::Job* reply) override {
    const auto job = cancel(*context, request->name());
    backend_.pool.wake();
    return answer(*context, job, reply);
  }

  grpc::Status ConfirmStep(grpc::ServerContext* context, const v1::ConfirmStepRequest* request,
                           v1::Job* reply) override {
    auto job = confirm(*request);
    if (!job) return to_grpc(never_again(std::move(job).error()));
    return answer(*context, job, reply);
  }

  grpc::Status ShareJob(grpc::ServerContext* context, const v1::ShareJobRequest* request,
                        v1::Job* reply) override {
    return answer(*context, share(*context, *request), reply);
  }

  grpc::Status PinJob(grpc::ServerContext* context, const v1::PinJobRequest* request,
                      v1::Job* reply) override {
    return answer(*context, pin(*context, *request), reply);
  }

  grpc::Status RetryJob(grpc::ServerContext* context, const v1::RetryJobRequest* request,
                        v1::Job* reply) override {
    return answer(*context, retry(*context, *request), reply);
  }

  grpc::Status WatchJob(grpc::ServerContext* context, const v1::WatchJobRequest* request,
                        grpc::ServerWriter<v1::WatchJobResponse>* writer) override {
    const int before = watches_.fetch_add(1);
    const Status status = before < kMostWatches ? watch(*context, *request, *writer)
                                                : fail(Code::kResourceExhausted,
                                                       "too many watches are open; list events "
                                                       "instead, or try again later",
                                                       "WATCHES_FULL");
    watches_.fetch_sub(1);
    return to_grpc(status);
  }

  grpc::Status ListJobEvents(grpc::ServerContext*, const v1::ListJobEventsRequest* request,
                             v1::ListJobEventsResponse* reply) override {
    return to_grpc(list_events(*request, *reply));
  }

 private:
  grpc::Status answer(const grpc::ServerContext& context, const Result<Job>& job,
                      v1::Job* reply) const {
    const auto caller = backend_.access.caller(context);
    if (!caller) return to_grpc(caller.error());
    if (!job) return to_grpc(job.error());
    *reply = shown_to(*caller, *job);
    return grpc::Status::OK;
  }

  Result<Job> get(const std::string& name) const {
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(name));
    return backend_.jobs.get(id);
  }

  // A job that the caller may change.
  Result<Job> own(const grpc::ServerContext& context, const std::string& name) const {
    HP_ASSIGN_OR_RETURN(const people::Caller caller, backend_.access.caller(context));
    HP_ASSIGN_OR_RETURN(const Job job, get(name));
    HP_RETURN_IF_ERROR(check_may_change(caller, job));
    return job;
  }

  Result<Job> cancel(const grpc::ServerContext& context, const std::string& name) {
    HP_ASSIGN_OR_RETURN(const Job job, own(context, name));
    const std::int64_t id = job.id;
    if (id == backend_.desk.dip()) return backend_.dips.cancel(id);
    if (id == backend_.captures.job()) return backend_.captures.cancel(id);
    return id == backend_.prints.job() ? backend_.prints.cancel(id) : backend_.jobs.cancel(id);
  }

  Result<Job> share(const grpc::ServerContext& context, const v1::ShareJobRequest& request) {
    HP_ASSIGN_OR_RETURN(const Job job, own(context, request.name()));
    return backend_.jobs.share(job.id, request.shared());
  }

  Result<Job> pin(const grpc::ServerContext& context, const v1::PinJobRequest& request) {
    HP_ASSIGN_OR_RETURN(const Job job, own(context, request.name()));
    return backend_.jobs.pin(job.id, request.pinned());
  }

  Result<Job> create(const grpc::ServerContext& context, const v1::CreateJobRequest& request) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_ASSIGN_OR_RETURN(const people::Caller caller, backend_.access.caller(context));
    HP_RETURN_IF_ERROR(check_may_create(caller, request.job(), backend_.jobs, backend_.assets));
    HP_RETURN_IF_ERROR(check_text("request_id", request.request_id(), 100));
    HP_ASSIGN_OR_RETURN(const v1::Job named, with_named_calibration(request.job(), backend_.jobs,
                                                                    backend_.calibrations));
    HP_ASSIGN_OR_RETURN(const v1::Job filled, fill_in(named));
    HP_ASSIGN_OR_RETURN(NewJob made, check_job(filled));
    made.body = body_of(told(named, filled));
    made.owner = caller.name;
    if (named.has_dip()) return create_dip(std::move(made), named, request);
    if (named.has_print()) return create_print(std::move(made), request);
    if (named.has_capture()) return create_capture(std::move(made), request);
    if (!request.validate_only()) return store(std::move(made), request_key("CreateJob", request));
    HP_RETURN_IF_ERROR(backend_.jobs.check_inputs(made.work.inputs));
    HP_ASSIGN_OR_RETURN(made.digest, digest_of(made.work));
    Job job;
    job.made = std::move(made);
    return job;
  }

  // What the job shows of what was filled in: what whoever goes on from it has to know.
  static v1::Job told(v1::Job named, const v1::Job& filled) {
    if (named.has_simulate()) *named.mutable_simulate() = filled.simulate();
    if (named.has_calibrate()) {
      named.mutable_calibrate()->set_camera_calibration(filled.calibrate().camera_calibration());
      if (filled.calibrate().has_gripper_mm()) {
        named.mutable_calibrate()->set_gripper_mm(filled.calibrate().gripper_mm());
      }
    }
    return named;
  }

  // With what a job takes from earlier ones and from the configuration.
  Result<v1::Job> fill_in(const v1::Job& job) {
    HP_ASSIGN_OR_RETURN(const v1::Job simulated,
                        with_simulated(job, backend_.jobs, backend_.assets, backend_.layout));
    HP_ASSIGN_OR_RETURN(
        const v1::Job captured,
        with_captured(simulated, {backend_.jobs, backend_.assets, backend_.calibrations,
                                  backend_.camera, backend_.layout}));
    return with_calibration(captured, backend_.calibrations, backend_.places.place());
  }

  Result<Job> create_dip(NewJob made, const v1::Job& named, const v1::CreateJobRequest& request) {
    HP_ASSIGN_OR_RETURN(const Lease lease, backend_.desk.leases().require(request.lease_id()));
    HP_ASSIGN_OR_RETURN(dip::Plan plan, plan_of(named.dip(), backend_.jobs, backend_.layout));
    HP_RETURN_IF_ERROR(go_by_calibration(named, backend_.jobs, backend_.calibrations,
                                         backend_.places.place(), plan));
    made.use_cache = false;
    if (request.validate_only()) {
      HP_RETURN_IF_ERROR(backend_.dips.check(plan));
      Job job;
      job.dip_status = first_dip_status(plan);
      job.state = JobState::kWaitingForOperator;
      job.made = std::move(made);
      return job;
    }
    HP_RETURN_IF_ERROR(check_free_space(backend_.layout.root, backend_.min_free_bytes));
    HP_ASSIGN_OR_RETURN(
        Job job, backend_.dips.create(std::move(made), request_key("CreateJob", request), plan,
                                      lease.holder));
    log_created(job);
    return job;
  }

  Result<Job> create_print(NewJob made, const v1::CreateJobRequest& request) {
    HP_ASSIGN_OR_RETURN(const PrintPlan plan,
                        print_plan_of(request.job().print(), backend_.jobs, backend_.layout));
    made.use_cache = false;
    if (request.validate_only()) {
      HP_RETURN_IF_ERROR(backend_.prints.check());
      Job job;
      job.made = std::move(made);
      return job;
    }
    HP_RETURN_IF_ERROR(check_free_space(backend_.layout.root, backend_.min_free_bytes));
    HP_ASSIGN_OR_RETURN(Job job,
                        backend_.prints.create(made, request_key("CreateJob", request), plan));
    log_created(job);
    return job;
  }

  Result<Job> create_capture(NewJob made, const v1::CreateJobRequest& request) {
    constexpr double kUsual_s = 2;
    const v1::CaptureSpec& spec = request.job().capture();
    made.use_cache = false;
    if (request.validate_only()) {
      HP_RETURN_IF_ERROR(backend_.captures.check());
      Job job;
      job.made = std::move(made);
      return job;
    }
    HP_RETURN_IF_ERROR(check_free_space(backend_.layout.root, backend_.min_free_bytes));
    HP_ASSIGN_OR_RETURN(Job job,
                        backend_.captures.create(made, request_key("CreateJob", request),
                                                 spec.has_seconds() ? spec.seconds() : kUsual_s));
    log_created(job);
    return job;
  }

  Result<Job> confirm(const v1::ConfirmStepRequest& request) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(request.name()));
    if (!v1::DipStatus::Step_IsValid(request.step()) ||
        request.step() == v1::DipStatus::STEP_UNSPECIFIED) {
      return invalid_field("step", "is no step of a dip");
    }
    HP_ASSIGN_OR_RETURN(const Lease lease, backend_.desk.leases().require(request.lease_id()));
    return backend_.dips.confirm(id, static_cast<dip::Step>(request.step()), lease.holder);
  }

  static void log_created(const Job& job) {
    log(LogLevel::kInfo, "job_created",
        {{"job", job.id},
         {"owner", job.made.owner},
         {"verb", job.made.work.verb},
         {"state", name_of(job.state)},
         {"name", job.made.display_name}});
  }

  Result<std::string> digest_of(const Work& work) const {
    HP_ASSIGN_OR_RETURN(const std::string worker, backend_.pool.program_digest());
    return input_digest(work, worker);
  }

  Result<Job> store(NewJob made, const RequestKey& key) {
    HP_ASSIGN_OR_RETURN(made.digest, digest_of(made.work));
    HP_RETURN_IF_ERROR(check_free_space(backend_.layout.root, backend_.min_free_bytes));
    HP_ASSIGN_OR_RETURN(Job job, backend_.jobs.create(made, key));
    backend_.pool.wake();
    log_created(job);
    return job;
  }

  Result<Job> retry(const grpc::ServerContext& context, const v1::RetryJobRequest& request) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_RETURN_IF_ERROR(check_text("request_id", request.request_id(), 100));
    HP_ASSIGN_OR_RETURN(const Job old, own(context, request.name()));
    const std::int64_t id = old.id;
    if (!is_finished(old.state)) {
      return fail(Code::kFailedPrecondition,
                  job_name(id) + " is " + name_of(old.state) + "; wait for its end or cancel it",
                  "STATE_FORBIDS");
    }
    if (moves_the_rig(old.made.work.verb)) {
      return fail(Code::kFailedPrecondition,
                  job_name(id) + " is a dip, which wants a new film; create a new one",
                  "STATE_FORBIDS");
    }
    if (prints(old.made.work.verb)) {
      return fail(Code::kFailedPrecondition,
                  job_name(id) +
                      " is a print, which may lie in the printer's tray; look, and "
                      "create a new one",
                  "STATE_FORBIDS");
    }
    if (captures(old.made.work.verb)) {
      return fail(Code::kFailedPrecondition,
                  job_name(id) + " is a capture, which is of its moment; create a new one",
                  "STATE_FORBIDS");
    }
    NewJob made = old.made;
    HP_ASSIGN_OR_RETURN(const people::Caller caller, backend_.access.caller(context));
    HP_RETURN_IF_ERROR(check_may_create(caller, to_message(old), backend_.jobs, backend_.assets));
    made.owner = caller.name;
    made.retry_of = id;
    made.use_cache = false;
    return store(std::move(made), request_key("RetryJob", request));
  }

  Status list(const grpc::ServerContext& context, const v1::ListJobsRequest& request,
              v1::ListJobsResponse& reply) {
    HP_ASSIGN_OR_RETURN(const people::Caller caller, backend_.access.caller(context));
    HP_ASSIGN_OR_RETURN(const int size, page_size(request.page_size(), 50));
    JobFilter filter;
    for (const int state : request.states()) {
      if (!v1::Job::State_IsValid(state)) return invalid_field("states", "has an unknown state");
      filter.states.push_back(static_cast<JobState>(state));
    }
    filter.owner = request.owner();
    HP_ASSIGN_OR_RETURN(filter.before_id, number_token(request.page_token()));
    filter.limit = size + 1;
    HP_ASSIGN_OR_RETURN(auto jobs, backend_.jobs.list(filter));
    if (cut_page(jobs, size)) reply.set_next_page_token(std::to_string(jobs.back().id));
    for (const Job& job : jobs) *reply.add_jobs() = shown_to(caller, job);
    return {};
  }

  Status list_events(const v1::ListJobEventsRequest& request, v1::ListJobEventsResponse& reply) {
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(request.parent()));
    HP_ASSIGN_OR_RETURN(const int size, page_size(request.page_size(), 100));
    HP_ASSIGN_OR_RETURN(const std::int64_t token, number_token(request.page_token()));
    HP_RETURN_IF_ERROR(backend_.jobs.get(id));
    const std::int64_t after = std::max(token, request.after_seq());
    HP_ASSIGN_OR_RETURN(auto events, backend_.jobs.events(id, after, size + 1));
    if (cut_page(events, size)) reply.set_next_page_token(std::to_string(events.back().seq));
    for (const JobEvent& event : events) *reply.add_events() = to_message(event);
    return {};
  }

  Status watch(const grpc::ServerContext& context, const v1::WatchJobRequest& request,
               grpc::ServerWriter<v1::WatchJobResponse>& writer) {
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(request.name()));
    HP_ASSIGN_OR_RETURN(const people::Caller caller, backend_.access.caller(context));
    const auto after = request.has_after_seq() ? std::optional(request.after_seq()) : std::nullopt;
    const auto send = [&](const WatchItem& item) {
      v1::WatchJobResponse message;
      message.set_seq(item.seq);
      if (item.job) *message.mutable_job() = shown_to(caller, *item.job);
      if (item.event) *message.mutable_event() = to_message(*item.event);
      return writer.Write(message);
    };
    Status still;
    const Status end = watch_job(backend_, id, after, send, [&] {
      still = backend_.access.check_still(context);
      return !still || context.IsCancelled();
    });
    return still ? end : still;
  }

  Backend backend_;
  std::atomic<int> watches_{0};
};

}  // namespace

std::unique_ptr<grpc::Service> make_job_service(const Backend& backend) {
  return std::make_unique<JobService>(backend);
}

}  // namespace hydroprint::daemon
