#include <fmt/format.h>

#include "daemon/api/job_watch.h"
#include "daemon/api/services.h"
#include "daemon/auth/visibility.h"
#include "daemon/jobs/job_request.h"
#include "daemon/jobs/plan_facts.h"
#include "daemon/jobs/registry.h"
#include "daemon/jobs/report.h"
#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/job_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr int kMaxWatches = 128;  // each occupies a thread

class JobService final : public v1::JobService::Service {
 public:
  explicit JobService(const ServiceContext& backend) : backend_(backend) {}

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
    return answer(*context, cancel(*context, request->name()), reply);
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

  grpc::Status GetPlanProgress(grpc::ServerContext* context,
                               const v1::GetPlanProgressRequest* request,
                               v1::PlanProgress* reply) override {
    auto progress = plan_progress(*context, request->name());
    if (!progress) return to_grpc(progress.error());
    *reply = std::move(*progress);
    return grpc::Status::OK;
  }

  grpc::Status GetJobReport(grpc::ServerContext* context, const v1::GetJobReportRequest* request,
                            v1::JobReport* reply) override {
    auto report = this->report(*context, request->name());
    if (!report) return to_grpc(report.error());
    *reply = std::move(*report);
    return grpc::Status::OK;
  }

  grpc::Status RetryJob(grpc::ServerContext* context, const v1::RetryJobRequest* request,
                        v1::Job* reply) override {
    return answer(*context, retry(*context, *request), reply);
  }

  grpc::Status WatchJob(grpc::ServerContext* context, const v1::WatchJobRequest* request,
                        grpc::ServerWriter<v1::WatchJobResponse>* writer) override {
    const int before = watches_.fetch_add(1);
    const Status status = before < kMaxWatches ? watch(*context, *request, *writer)
                                               : fail(Code::kResourceExhausted,
                                                      "too many watches are open; list events "
                                                      "instead, or try again later",
                                                      ErrorReason::WATCHES_FULL);
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
    const auto caller = caller_of(context);
    if (!caller) return to_grpc(caller.error());
    if (!job) return to_grpc(job.error());
    *reply = shown_to(*caller, *job);
    return grpc::Status::OK;
  }

  Result<Job> get(const std::string& name) const {
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(name));
    return backend_.jobs.get(id);
  }

  // Loads a job that the caller may change.
  Result<Job> own(const grpc::ServerContext& context, const std::string& name) const {
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const Job job, get(name));
    HP_RETURN_IF_ERROR(check_may_change(caller, job));
    return job;
  }

  Result<Job> cancel(const grpc::ServerContext& context, const std::string& name) {
    HP_ASSIGN_OR_RETURN(const Job job, own(context, name));
    HP_ASSIGN_OR_RETURN(const JobKind* const kind, kind_of(job));
    return backend_.executors[kind->executor()].cancel(job.id);
  }

  Result<Job> share(const grpc::ServerContext& context, const v1::ShareJobRequest& request) {
    HP_ASSIGN_OR_RETURN(const Job job, own(context, request.name()));
    return backend_.jobs.share(job.id, request.shared());
  }

  Result<Job> pin(const grpc::ServerContext& context, const v1::PinJobRequest& request) {
    HP_ASSIGN_OR_RETURN(const Job job, own(context, request.name()));
    return backend_.retention.pin(job.id, request.pinned());
  }

  Result<Job> create(const grpc::ServerContext& context, const v1::CreateJobRequest& request) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const JobKind* const kind, kind_of(request.job()));
    HP_RETURN_IF_ERROR(check_may_create(caller, kind->least_role(), request.job(), backend_.jobs,
                                        backend_.database));
    HP_RETURN_IF_ERROR(check_text("request_id", request.request_id(), 100));
    HP_ASSIGN_OR_RETURN(JobRequest checked, job_request(*kind, request.job(), sources()));
    checked.definition.owner = caller.name;
    checked.key = request_key("CreateJob", request);
    checked.lease_id = request.lease_id();
    JobExecutor& executor = backend_.executors[kind->executor()];
    return request.validate_only() ? executor.check(checked) : store(executor, checked);
  }

  Result<v1::PlanProgress> plan_progress(const grpc::ServerContext& context,
                                         const std::string& name) const {
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const Job plan, get(name));
    HP_RETURN_IF_ERROR(check_may_see(caller, plan));
    HP_ASSIGN_OR_RETURN(const PlanFacts facts, plan_facts(name, caller.name, sources()));
    return progress_of(facts);
  }

  Result<v1::JobReport> report(const grpc::ServerContext& context, const std::string& name) const {
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const Job job, get(name));
    HP_RETURN_IF_ERROR(check_may_see(caller, job));
    HP_RETURN_IF_ERROR(backend_.jobs.sound_artifact(job.id, kReport));
    auto report = read_report(backend_.layout.artifacts(job.id), job.definition.work.verb);
    if (report && report->report_case() == v1::JobReport::REPORT_NOT_SET)
      return fail(Code::kNotFound, name + " has no report", ErrorReason::ARTIFACT_NOT_FOUND);
    return report;
  }

  [[nodiscard]] JobSources sources() const {
    return {backend_.jobs,   backend_.assets, backend_.calibrations,
            backend_.camera, backend_.layout, backend_.places.place()};
  }

  Result<Job> store(JobExecutor& executor, const JobRequest& request) {
    HP_RETURN_IF_ERROR(check_free_space(backend_.layout.root, backend_.min_free_bytes));
    HP_ASSIGN_OR_RETURN(Job job, executor.create(request));
    log(LogLevel::kInfo, "job_created",
        {{"job", job.id},
         {"owner", job.definition.owner},
         {"verb", job.definition.work.verb},
         {"state", name_of(job.state)},
         {"name", job.definition.display_name}});
    return job;
  }

  Result<Job> confirm(const v1::ConfirmStepRequest& request) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(request.name()));
    if (!v1::DipStatus::Step_IsValid(request.step()) ||
        request.step() == v1::DipStatus::STEP_UNSPECIFIED) {
      return invalid_field("step", "must be a step of a dip, from PRINT_FILM to RETRACT");
    }
    HP_ASSIGN_OR_RETURN(const Lease lease, backend_.gateway.leases().require(request.lease_id()));
    return backend_.dips.confirm(id, static_cast<dip::Step>(request.step()), lease.holder);
  }

  Result<Job> retry(const grpc::ServerContext& context, const v1::RetryJobRequest& request) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_RETURN_IF_ERROR(check_text("request_id", request.request_id(), 100));
    HP_ASSIGN_OR_RETURN(const Job old, own(context, request.name()));
    HP_ASSIGN_OR_RETURN(const JobKind* const kind, kind_of(old));
    HP_RETURN_IF_ERROR(check_may_retry(old, *kind));
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    JobRequest again;
    again.job = to_message(old);
    HP_RETURN_IF_ERROR(
        check_may_create(caller, kind->least_role(), again.job, backend_.jobs, backend_.database));
    again.definition = old.definition;
    again.definition.owner = caller.name;
    again.definition.retry_of = old.id;
    again.definition.use_cache = false;
    again.key = request_key("RetryJob", request);
    return store(backend_.executors[kind->executor()], again);
  }

  static Status check_may_retry(const Job& job, const JobKind& kind) {
    std::string why = kind.why_no_retry();
    if (!is_finished(job.state)) {
      why = fmt::format("{}; wait until it ends, or cancel it", name_of(job.state));
    }
    if (why.empty()) return {};
    return fail(Code::kFailedPrecondition, fmt::format("{} is {}", job_name(job.id), why),
                ErrorReason::STATE_FORBIDS);
  }

  Status list(const grpc::ServerContext& context, const v1::ListJobsRequest& request,
              v1::ListJobsResponse& reply) {
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const int size, page_size(request.page_size(), 50));
    JobFilter filter;
    for (const int state : request.states()) {
      if (!v1::Job::State_IsValid(state))
        return invalid_field("states", "contains an unknown state");
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
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
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
      still = backend_.access.check_still(caller);
      return !still || context.IsCancelled();
    });
    return still ? end : still;
  }

  ServiceContext backend_;
  std::atomic<int> watches_{0};
};

}  // namespace

std::unique_ptr<grpc::Service> make_job_service(const ServiceContext& backend) {
  return std::make_unique<JobService>(backend);
}

}  // namespace hydroprint::daemon
