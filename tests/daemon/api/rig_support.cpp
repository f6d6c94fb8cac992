#include "tests/daemon/api/rig_support.h"

#include <grpcpp/generic/generic_stub.h>

#include <stdexcept>

namespace hydroprint::tests {
namespace {

void check(const grpc::Status& status, const std::string& call) {
  if (status.ok()) return;
  throw std::runtime_error(call + ": " + reason_of(status) + ": " + status.error_message());
}

}  // namespace

RigClient::RigClient(const std::string& address, const std::string& owner)
    : Client(address, owner),
      rigs(v1::RigService::NewStub(channel)),
      leases(v1::LeaseService::NewStub(channel)) {}

v1::Rig RigClient::rig() {
  v1::Rig reply;
  check(rigs->GetRig(context().get(), {}, &reply), "GetRig");
  return reply;
}

grpc::Status RigClient::acquire(v1::Lease& lease, int seconds, const std::string& request_id) {
  v1::AcquireLeaseRequest request;
  request.set_purpose("test");
  request.mutable_ttl()->set_seconds(seconds);
  request.set_request_id(request_id);
  return leases->AcquireLease(context().get(), request, &lease);
}

void RigClient::take_lease(int seconds) {
  v1::Lease lease;
  check(acquire(lease, seconds), "AcquireLease");
  lease_id = lease.lease_id();
}

grpc::Status RigClient::break_lease(const std::string& reason) {
  v1::BreakLeaseRequest request;
  request.set_reason(reason);
  google::protobuf::Empty reply;
  return leases->BreakLease(context().get(), request, &reply);
}

grpc::Status RigClient::release() {
  v1::ReleaseLeaseRequest request;
  request.set_lease_id(lease_id);
  google::protobuf::Empty reply;
  return leases->ReleaseLease(context().get(), request, &reply);
}

grpc::Status RigClient::arm() {
  v1::ArmRequest request;
  request.set_lease_id(lease_id);
  v1::Rig reply;
  return rigs->Arm(context().get(), request, &reply);
}

grpc::Status RigClient::disarm() {
  v1::DisarmRequest request;
  request.set_lease_id(lease_id);
  v1::Rig reply;
  return rigs->Disarm(context().get(), request, &reply);
}

grpc::Status RigClient::home(const std::string& request_id) {
  v1::HomeRequest request;
  request.set_lease_id(lease_id);
  request.set_request_id(request_id);
  v1::Rig reply;
  return rigs->Home(context().get(), request, &reply);
}

grpc::Status RigClient::move_to(double position_mm, double speed_mm_per_s,
                                const std::string& request_id) {
  v1::MoveToRequest request;
  request.set_lease_id(lease_id);
  request.set_position_mm(position_mm);
  request.set_speed_mm_per_s(speed_mm_per_s);
  request.set_request_id(request_id);
  v1::Rig reply;
  return rigs->MoveTo(context().get(), request, &reply);
}

grpc::Status RigClient::jog(double speed_mm_per_s) {
  v1::JogRequest request;
  request.set_lease_id(lease_id);
  request.set_speed_mm_per_s(speed_mm_per_s);
  v1::Rig reply;
  return rigs->Jog(context().get(), request, &reply);
}

grpc::Status RigClient::stop() {
  v1::Rig reply;
  return rigs->StopMotion(context().get(), {}, &reply);
}

grpc::Status RigClient::reset() {
  v1::ResetFaultRequest request;
  request.set_lease_id(lease_id);
  v1::Rig reply;
  return rigs->ResetFault(context().get(), request, &reply);
}

bool RigClient::becomes(v1::Rig::State state, double seconds) {
  return wait_until([&] { return rig().state() == state; }, seconds);
}

void RigClient::make_ready() {
  if (lease_id.empty()) take_lease();
  if (!becomes(v1::Rig::DISARMED)) throw std::runtime_error("the rig did not become DISARMED");
  check(arm(), "Arm");
  check(home(), "Home");
  if (!becomes(v1::Rig::IDLE, 30)) throw std::runtime_error("the rig was not homed within 30 s");
}

void RigClient::go_to(double position_mm) {
  check(move_to(position_mm), "MoveTo");
  if (!becomes(v1::Rig::IDLE, 30)) throw std::runtime_error("the move did not end within 30 s");
}

grpc::Status RigClient::create_dip(const v1::DipSpec& spec, v1::Job& job) {
  v1::CreateJobRequest request;
  *request.mutable_job()->mutable_dip() = spec;
  request.set_lease_id(lease_id);
  return create(request, job);
}

v1::Job RigClient::dip(const v1::DipSpec& spec) {
  v1::Job job;
  check(create_dip(spec, job), "CreateJob");
  return job;
}

grpc::Status RigClient::confirm(const std::string& job, v1::DipStatus::Step step) {
  v1::ConfirmStepRequest request;
  request.set_name(job);
  request.set_step(step);
  request.set_lease_id(lease_id);
  v1::Job reply;
  return jobs->ConfirmStep(context().get(), request, &reply);
}

v1::Job RigClient::wait_for_step(const std::string& name, v1::DipStatus::Step step) {
  return wait(name,
              [&](const v1::Job& now) { return now.dip_status().step() == step || finished(now); });
}

v1::Job RigClient::guide_to(const std::string& name, v1::DipStatus::Step step) {
  for (;;) {
    const v1::Job now = wait(name, [&](const v1::Job& job) {
      return job.state() == v1::Job::WAITING_FOR_OPERATOR || job.dip_status().step() == step ||
             finished(job);
    });
    if (now.dip_status().step() == step || finished(now)) return now;
    check(confirm(name, now.dip_status().step()),
          "ConfirmStep " + v1::DipStatus::Step_Name(now.dip_status().step()));
  }
}

nlohmann::json RigClient::report(const std::string& name) {
  return nlohmann::json::parse(download(name + "/artifacts/report.json"));
}

std::string reason_of(const grpc::Status& status) {
  return status.ok() ? "" : error_info(status).reason();
}

std::string health_of(const Client& client, const std::string& service) {
  // grpc.health.v1: HealthCheckRequest{string service = 1}, HealthCheckResponse{enum status = 1}.
  grpc::GenericStub stub(client.channel);
  const std::string request = std::string("\x0a") + static_cast<char>(service.size()) + service;
  grpc::Slice slice(request);
  const grpc::ByteBuffer bytes(&slice, 1);
  grpc::ByteBuffer reply;
  grpc::CompletionQueue queue;
  const auto context = client.context();
  const auto call =
      stub.PrepareUnaryCall(context.get(), "/grpc.health.v1.Health/Check", bytes, &queue);
  call->StartCall();
  grpc::Status status;
  call->Finish(&reply, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  check(status, "Health.Check");
  std::vector<grpc::Slice> slices;
  if (!reply.Dump(&slices).ok() || slices.empty() || slices.front().size() < 2) return "";
  return slices.front().begin()[1] == 1 ? "SERVING" : "NOT_SERVING";
}

v1::DipSpec short_dip() {
  v1::DipSpec spec;
  spec.set_depth_mm(5);
  spec.set_speed_mm_per_s(10);
  spec.set_hold_s(0.3);
  spec.set_clearance_mm(3);
  spec.set_soak_s(0.1);
  spec.set_activator_wait_s(0.1);
  return spec;
}

}  // namespace hydroprint::tests
