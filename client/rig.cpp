#include "client/rig.h"

#include <chrono>

#include "client/connection/rpc.h"
#include "client/uuid.h"

namespace hydroprint::client {
namespace {

using RigStub = v1::RigService::Stub;

// Deadline of a jog command. The next command follows after 100 ms, so a delayed command must not
// take effect late.
constexpr std::chrono::milliseconds kJogAnswerLimit{250};

template <class Request>
Request leased(const std::string& lease_id) {
  Request request;
  request.set_lease_id(lease_id);
  return request;
}

template <class Request>
Result<v1::Rig> command(Connection& connection,
                        grpc::Status (RigStub::*method)(grpc::ClientContext*, const Request&,
                                                        v1::Rig*),
                        const Request& request, std::chrono::milliseconds limit = kAnswerLimit) {
  return call_once(connection, *connection.impl().rig, method, request, limit);
}

}  // namespace

Result<v1::Rig> get_rig(Connection& connection) {
  return call(connection, *connection.impl().rig, &RigStub::GetRig, v1::GetRigRequest());
}

Status watch_rig(Connection& connection, double max_rate_hz,
                 const std::function<bool(const v1::Rig&)>& update) {
  v1::WatchRigRequest request;
  request.set_max_rate_hz(max_rate_hz);
  Call one(connection);
  wait_for_connection(connection, kConnectLimit);
  auto stream = connection.impl().rig->WatchRig(one.context(), request);
  v1::Rig rig;
  while (stream->Read(&rig)) {
    if (update(rig)) continue;
    one.context()->TryCancel();
    while (stream->Read(&rig)) continue;
    static_cast<void>(stream->Finish());
    return {};
  }
  const grpc::Status status = stream->Finish();
  if (!status.ok()) return tl::unexpected(to_error(connection, status));
  return fail(Code::kUnavailable, "the daemon closed the stream");
}

Result<v1::Rig> arm_rig(Connection& connection, const std::string& lease_id) {
  return command(connection, &RigStub::Arm, leased<v1::ArmRequest>(lease_id));
}

Result<v1::Rig> disarm_rig(Connection& connection, const std::string& lease_id) {
  return command(connection, &RigStub::Disarm, leased<v1::DisarmRequest>(lease_id));
}

Result<v1::Rig> home_rig(Connection& connection, const std::string& lease_id) {
  auto request = leased<v1::HomeRequest>(lease_id);
  request.set_request_id(make_uuid());
  return command(connection, &RigStub::Home, request);
}

Result<v1::Rig> move_rig(Connection& connection, const std::string& lease_id, double position_mm,
                         std::optional<double> speed_mm_per_s) {
  auto request = leased<v1::MoveToRequest>(lease_id);
  request.set_position_mm(position_mm);
  if (speed_mm_per_s) request.set_speed_mm_per_s(*speed_mm_per_s);
  request.set_request_id(make_uuid());
  return command(connection, &RigStub::MoveTo, request);
}

Result<v1::Rig> jog_rig(Connection& connection, const std::string& lease_id,
                        double speed_mm_per_s) {
  auto request = leased<v1::JogRequest>(lease_id);
  request.set_speed_mm_per_s(speed_mm_per_s);
  return command(connection, &RigStub::Jog, request, kJogAnswerLimit);
}

Result<v1::Rig> reset_rig(Connection& connection, const std::string& lease_id) {
  return command(connection, &RigStub::ResetFault, leased<v1::ResetFaultRequest>(lease_id));
}

Result<v1::Rig> stop_rig(Connection& connection) {
  return call(connection, *connection.impl().rig, &RigStub::StopMotion, v1::StopMotionRequest());
}

}  // namespace hydroprint::client
