#include "daemon/api/services.h"
#include "daemon/api/to_proto_queue.h"
#include "daemon/jobs/field_check.h"
#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/queue_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

class QueueService final : public v1::QueueService::Service {
 public:
  explicit QueueService(const ServiceContext& backend) : backend_(backend) {}

  grpc::Status GetQueue(grpc::ServerContext*, const v1::GetQueueRequest*,
                        v1::Queue* reply) override {
    return to_grpc(show(*reply));
  }

  grpc::Status PauseQueue(grpc::ServerContext*, const v1::PauseQueueRequest* request,
                          v1::Queue* reply) override {
    const Status good = check_fields(*request);
    return good ? to_grpc(set({true, request->reason()}, *reply)) : to_grpc(good);
  }

  grpc::Status ResumeQueue(grpc::ServerContext*, const v1::ResumeQueueRequest*,
                           v1::Queue* reply) override {
    return to_grpc(set({}, *reply));
  }

  grpc::Status MoveJob(grpc::ServerContext*, const v1::MoveJobRequest* request,
                       v1::Job* reply) override {
    const auto job = move(*request);
    if (!job) return to_grpc(job.error());
    *reply = to_message(*job);  // callers are operators, who may see everything
    return grpc::Status::OK;
  }

 private:
  Status show(v1::Queue& reply) {
    HP_ASSIGN_OR_RETURN(reply, queue_message(backend_));
    return {};
  }

  Status set(const QueuePause& pause, v1::Queue& reply) {
    HP_RETURN_IF_ERROR(backend_.queue.set_pause(pause));
    backend_.pool.wake();
    log(LogLevel::kInfo, pause.paused ? "queue_paused" : "queue_resumed",
        {{"reason", pause.reason}});
    return show(reply);
  }

  Result<Job> move(const v1::MoveJobRequest& request) {
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_job_name(request.name()));
    std::int64_t before = 0;
    if (!request.before().empty()) {
      HP_ASSIGN_OR_RETURN(before, parse_job_name(request.before()));
    }
    return backend_.queue.move(id, before);
  }

  ServiceContext backend_;
};

}  // namespace

std::unique_ptr<grpc::Service> make_queue_service(const ServiceContext& backend) {
  return std::make_unique<QueueService>(backend);
}

}  // namespace hydroprint::daemon
