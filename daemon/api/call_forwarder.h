#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/generic/generic_stub.h>

#include <memory>

#include "daemon/auth/role_check.h"

namespace hydroprint::daemon {

/// The only service of the gRPC endpoint. It authorizes each call by its headers before it reads a
/// message, and forwards authorized calls to the services within the process. gRPC's own health and
/// reflection services need no sign-in.
class CallForwarder final : public grpc::CallbackGenericService {
 public:
  /// @param services  channel to the services
  CallForwarder(std::shared_ptr<grpc::Channel> services, const RoleCheck& roles)
      : stub_(std::move(services)), roles_(roles) {}

  grpc::ServerGenericBidiReactor* CreateReactor(
      grpc::GenericCallbackServerContext* context) override;

 private:
  grpc::GenericStub stub_;
  const RoleCheck& roles_;
};

}  // namespace hydroprint::daemon
