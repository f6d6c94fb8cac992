#include "client/connection/health.h"

#include <grpcpp/generic/generic_stub.h>

#include "client/connection/rpc.h"

namespace hydroprint::client {
namespace {

constexpr char kMethod[] = "/grpc.health.v1.Health/Check";

grpc::Status check(Connection& connection, grpc::ByteBuffer& answer) {
  Call call(connection, kAnswerLimit);
  grpc::GenericStub stub(connection.impl().channel);
  grpc::CompletionQueue queue;
  grpc::ByteBuffer request(nullptr, 0);  // empty HealthCheckRequest: the server as a whole
  grpc::Status status;
  auto reader = stub.PrepareUnaryCall(call.context(), kMethod, request, &queue);
  reader->StartCall();
  reader->Finish(&answer, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  return status;
}

}  // namespace

// Debian has no generated client code for grpc.health.v1, so the reply is parsed here.
// HealthCheckResponse has one field: enum, field 1, varint, 0 UNKNOWN, 1 SERVING, 2 NOT_SERVING.
Result<std::string> check_health(Connection& connection) {
  grpc::ByteBuffer answer;
  const grpc::Status status = with_retries(connection, [&] { return check(connection, answer); });
  if (!status.ok()) return tl::unexpected(to_error(connection, status));
  grpc::Slice bytes;
  if (!answer.DumpToSingleSlice(&bytes).ok() || bytes.size() != 2 || bytes.begin()[0] != 0x08)
    return "UNKNOWN";
  if (bytes.begin()[1] == 1) return "SERVING";
  return bytes.begin()[1] == 2 ? "NOT_SERVING" : "UNKNOWN";
}

}  // namespace hydroprint::client
