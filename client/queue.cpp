#include "client/queue.h"

#include "client/connection/rpc.h"

namespace hydroprint::client {
namespace {

using QueueStub = v1::QueueService::Stub;

}  // namespace

Result<v1::Queue> get_queue(Connection& connection) {
  return call(connection, *connection.impl().queue, &QueueStub::GetQueue, v1::GetQueueRequest());
}

Result<v1::Queue> pause_queue(Connection& connection, const std::string& reason) {
  v1::PauseQueueRequest request;
  request.set_reason(reason);
  return call(connection, *connection.impl().queue, &QueueStub::PauseQueue, request);
}

Result<v1::Queue> resume_queue(Connection& connection) {
  return call(connection, *connection.impl().queue, &QueueStub::ResumeQueue,
              v1::ResumeQueueRequest());
}

Result<v1::Job> move_job(Connection& connection, const std::string& name,
                         const std::string& before) {
  auto request = named<v1::MoveJobRequest>(name);
  request.set_before(before);
  return call(connection, *connection.impl().queue, &QueueStub::MoveJob, request);
}

}  // namespace hydroprint::client
