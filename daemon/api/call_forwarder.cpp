#include "daemon/api/call_forwarder.h"

#include <grpcpp/client_context.h>

#include <mutex>

#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"

namespace hydroprint::daemon {
namespace {

// Returns the host in "ipv4:127.0.0.1:50051" or "ipv6:%5B::1%5D:50051".
std::string address_in(const std::string& peer) {
  if (!peer.starts_with("ipv4:") && !peer.starts_with("ipv6:")) return peer;
  std::string host = peer.substr(5, peer.rfind(':') - 5);
  for (const char* bracket : {"%5B", "%5D", "[", "]"}) {
    if (const auto at = host.find(bracket); at != std::string::npos) {
      host.erase(at, std::string_view(bracket).size());
    }
  }
  return host;
}

/// Returns the credentials of a call from the network. The peer is the address of the connection;
/// other metadata that the services trust is never taken from the client.
auth::Credentials presented_credentials(const grpc::ServerContextBase& context) {
  auth::Credentials credentials = credentials_of(context);
  credentials.peer = address_in(context.peer());
  return credentials;
}

bool is_grpcs_own(std::string_view method) {
  return method.starts_with("/grpc.health.v1.") || method.starts_with("/grpc.reflection.v1alpha.");
}

class ForwardedCall;

/// The client end of the channel within the process, through which the call reaches the service.
/// Reports its events to the forwarded call.
class ServiceSide final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  explicit ServiceSide(ForwardedCall& call) : call_(call) {}

  void begin(grpc::GenericStub& stub, const std::string& method, const CallMetadata& metadata,
             std::chrono::system_clock::time_point deadline) {
    for (const auto& [name, value] : metadata) context_.AddMetadata(name, value);
    context_.set_deadline(deadline);
    stub.PrepareBidiStreamingCall(&context_, method, {}, this);
    AddHold();  // because writes start outside the callbacks of this reactor
    StartCall();
    // A read is always pending, because within a process, gRPC drops a response that is not being
    // read when the status arrives.
    StartRead(&response);
  }
  void write() {
    if (!enter()) return;
    StartWrite(&request);
    leave();
  }
  void end_writing() {
    if (!enter()) return;
    StartWritesDone();
    leave();
  }
  void read() { StartRead(&response); }
  void cancel() {
    context_.TryCancel();
    close();
  }
  void try_cancel() { context_.TryCancel(); }

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnDone(const grpc::Status& status) override;

  grpc::ByteBuffer request, response;

 private:
  // No operation may be started on a call after its hold is removed.
  bool enter() {
    const std::lock_guard lock(mutex_);
    if (!is_closed_) ++inside_;
    return !is_closed_;
  }
  void leave() {
    bool is_last = false;
    {
      const std::lock_guard lock(mutex_);
      is_last = --inside_ == 0 && is_closed_;
    }
    if (is_last) RemoveHold();
  }
  void close() {
    bool is_last = false;
    {
      const std::lock_guard lock(mutex_);
      if (is_closed_) return;
      is_closed_ = true;
      is_last = inside_ == 0;
    }
    if (is_last) RemoveHold();
  }

  ForwardedCall& call_;
  grpc::ClientContext context_;
  std::mutex mutex_;  // protects the members below
  bool is_closed_ = false;
  int inside_ = 0;
};

/// One forwarded call. In each direction, a message is read after the previous message has been
/// accepted.
class ForwardedCall final : public grpc::ServerGenericBidiReactor {
 public:
  ForwardedCall(grpc::GenericStub& stub, const grpc::GenericCallbackServerContext& context,
                const CallMetadata& metadata) {
    service_.begin(stub, context.method(), metadata, context.deadline());
    read();
  }

  // Called by ServiceSide.
  void read() { StartRead(&service_.request); }
  void respond() { StartWrite(&service_.response); }
  void finish(const grpc::Status& status) { Finish(status); }

  // Called by gRPC for events on the client's side.
  void OnReadDone(bool ok) override { ok ? service_.write() : service_.end_writing(); }
  void OnWriteDone(bool ok) override { ok ? service_.read() : service_.cancel(); }
  void OnCancel() override { service_.try_cancel(); }
  void OnDone() override { delete this; }

 private:
  ServiceSide service_{*this};
};

void ServiceSide::OnReadDone(bool ok) { ok ? call_.respond() : close(); }
void ServiceSide::OnWriteDone(bool ok) {
  if (ok) call_.read();
}
void ServiceSide::OnDone(const grpc::Status& status) { call_.finish(status); }

class RefusedCall final : public grpc::ServerGenericBidiReactor {
 public:
  explicit RefusedCall(const grpc::Status& status) { Finish(status); }
  void OnDone() override { delete this; }
};

}  // namespace

grpc::ServerGenericBidiReactor* CallForwarder::CreateReactor(
    grpc::GenericCallbackServerContext* context) {
  const auth::Credentials credentials = presented_credentials(*context);
  if (is_grpcs_own(context->method())) {
    return new ForwardedCall(stub_, *context, caller_metadata({}, credentials));
  }
  const auto caller = roles_.admit(context->method(), credentials);
  if (!caller) return new RefusedCall(to_grpc(caller.error()));
  return new ForwardedCall(stub_, *context, caller_metadata(*caller, credentials));
}

}  // namespace hydroprint::daemon
