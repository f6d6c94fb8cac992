#include "daemon/auth/role_check.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/empty.pb.h>
#include <google/protobuf/message_lite.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/impl/rpc_service_method.h>
#include <grpcpp/support/method_handler.h>

#include <deque>

#include "daemon/rpc/grpc_status.h"
#include "hydroprint/v1/access.pb.h"

namespace hydroprint::daemon {
namespace {

using google::protobuf::Empty;
using google::protobuf::MethodDescriptor;
using google::protobuf::ServiceDescriptor;
using grpc::internal::MethodHandler;
using grpc::internal::RpcMethod;
using grpc::internal::RpcServiceMethod;

// Exposes a protected member of gRPC's service class.
struct Opened : grpc::Service {
  static MethodHandler* handler_of(grpc::Service& service, int index) {
    return (service.*(&Opened::GetHandler))(index);
  }
};

class GatedHandler final : public MethodHandler {
 public:
  GatedHandler(MethodHandler& inner, const Authenticator& access, auth::Role needed)
      : inner_(inner), access_(access), needed_(needed) {}

  void RunHandler(const HandlerParameter& call) final {
    const auto caller = access_.admit(*call.server_context, needed_);
    if (caller) {
      inner_.RunHandler(call);
      return;
    }
    // The request lives in the call's memory, and only its handler would destroy it.
    if (call.request != nullptr) {
      static_cast<google::protobuf::MessageLite*>(call.request)->~MessageLite();
    }
    // Unlike gRPC's other handlers, this one does not read a request before it answers.
    grpc::internal::ClientStreamingHandler<grpc::Service, Empty, Empty>(
        [&](auto&&...) { return to_grpc(caller.error()); }, nullptr)
        .RunHandler(call);
  }

  void* Deserialize(grpc_call* call, grpc_byte_buffer* request, grpc::Status* status,
                    void** data) final {
    return inner_.Deserialize(call, request, status, data);
  }

 private:
  MethodHandler& inner_;
  const Authenticator& access_;
  auth::Role needed_;
};

class OpenHandler final : public MethodHandler {
 public:
  explicit OpenHandler(MethodHandler& inner) : inner_(inner) {}
  void RunHandler(const HandlerParameter& call) final { inner_.RunHandler(call); }
  void* Deserialize(grpc_call* call, grpc_byte_buffer* request, grpc::Status* status,
                    void** data) final {
    return inner_.Deserialize(call, request, status, data);
  }

 private:
  MethodHandler& inner_;
};

RpcMethod::RpcType type_of(const MethodDescriptor& method) {
  if (method.client_streaming()) {
    return method.server_streaming() ? RpcMethod::BIDI_STREAMING : RpcMethod::CLIENT_STREAMING;
  }
  return method.server_streaming() ? RpcMethod::SERVER_STREAMING : RpcMethod::NORMAL_RPC;
}

class Gate final : public grpc::Service {
 public:
  explicit Gate(std::unique_ptr<grpc::Service> inner) : inner_(std::move(inner)) {}

  void add(const MethodDescriptor& method, const Need& need, const Authenticator& access,
           bool checks_itself) {
    MethodHandler& handler = *Opened::handler_of(*inner_, method.index());
    names_.push_back("/" + method.service()->full_name() + "/" + method.name());
    std::unique_ptr<MethodHandler> mine;
    if (need && !checks_itself) {
      mine = std::make_unique<GatedHandler>(handler, access, *need);
    } else {
      mine = std::make_unique<OpenHandler>(handler);
    }
    auto added =
        std::make_unique<RpcServiceMethod>(names_.back().c_str(), type_of(method), mine.release());
    if (checks_itself) added->SetServerApiType(RpcServiceMethod::ApiType::CALL_BACK);
    AddMethod(added.release());  // takes ownership
  }

 private:
  std::unique_ptr<grpc::Service> inner_;
  std::deque<std::string> names_;  // gRPC keeps pointers to these
};

}  // namespace

Result<Need> need_of(const MethodDescriptor& method) {
  const bool is_open = method.options().GetExtension(v1::without_sign_in);
  const v1::Role role = method.options().GetExtension(v1::role);
  const bool has_role = v1::Role_IsValid(role) && role != v1::ROLE_UNSPECIFIED;
  if (is_open != has_role) {
    return is_open ? Need() : Need(static_cast<auth::Role>(role));
  }
  return fail(Code::kInternal, method.full_name() +
                                   ": states no access rule; give it either the option "
                                   "role or without_sign_in (hydroprint/v1/access.proto)");
}

Result<std::unique_ptr<grpc::Service>> guarded(const std::string& name,
                                               std::unique_ptr<grpc::Service> inner,
                                               const Authenticator& access,
                                               const std::set<std::string>& check_themselves) {
  const ServiceDescriptor* const service =
      google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(name);
  if (service == nullptr) return fail(Code::kInternal, name + ": there is no such service");
  auto gate = std::make_unique<Gate>(std::move(inner));
  for (int i = 0; i < service->method_count(); ++i) {
    const MethodDescriptor& method = *service->method(i);
    HP_ASSIGN_OR_RETURN(const Need need, need_of(method));
    gate->add(method, need, access, check_themselves.contains(method.name()));
  }
  return std::unique_ptr<grpc::Service>(std::move(gate));
}

}  // namespace hydroprint::daemon
