#include "client/queue.h"

#include <utility>

#include "client/connection/rpc.h"
#include "client/convert.h"

namespace hydroprint::client {
namespace {

using QueueStub = v1::QueueService::Stub;

Result<Queue> to_queue(Result<v1::Queue> answer) {
  return std::move(answer).map([](const v1::Queue& queue) { return from_proto(queue); });
}

}  // namespace

Result<Queue> get_queue(Connection& connection) {
  return to_queue(
      call(connection, *connection.impl().queue, &QueueStub::GetQueue, v1::GetQueueRequest()));
}

Result<Queue> pause_queue(Connection& connection, const std::string& reason) {
  v1::PauseQueueRequest request;
  request.set_reason(reason);
  return to_queue(call(connection, *connection.impl().queue, &QueueStub::PauseQueue, request));
}

Result<Queue> resume_queue(Connection& connection) {
  return to_queue(call(connection, *connection.impl().queue, &QueueStub::ResumeQueue,
                       v1::ResumeQueueRequest()));
}

Result<Job> move_job(Connection& connection, const std::string& name, const std::string& before) {
  v1::MoveJobRequest request;
  request.set_name(name);
  request.set_before(before);
  HP_ASSIGN_OR_RETURN(const v1::Job job,
                      call(connection, *connection.impl().queue, &QueueStub::MoveJob, request));
  return from_proto(job);
}

}  // namespace hydroprint::client
