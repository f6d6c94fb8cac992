#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "daemon/api/service_context.h"
#include "daemon/auth/role_check.h"
#include "daemon/config/config.h"
#include "daemon/tls/identity.h"

namespace grpc {
class Channel;
}

namespace hydroprint::daemon {

/// The services, health for each of them, reflection if wanted; and the gRPC endpoint, which admits
/// calls and forwards them to the services (call_forwarder.h). The services are called within the
/// process only.
class Server {
 public:
  /// Listens; calls are answered from here on.
  /// @param identity  TLS certificate and key; null: without TLS
  /// @return kUnavailable if the address cannot be bound, usually because it is in use
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(const Endpoint& endpoint,
                                                             bool reflection,
                                                             const ServiceContext& backend,
                                                             tls::CurrentIdentity identity);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Channel to the services for another endpoint, which admits its own calls; may outlive this.
  [[nodiscard]] std::shared_ptr<grpc::Channel> in_process() const;
  /// The check that every endpoint makes before it calls the services.
  [[nodiscard]] const RoleCheck& roles() const;
  /// The address it listens at, with the real port.
  [[nodiscard]] const Endpoint& endpoint() const;
  /// Health status of the RigService; false at first.
  void set_rig_serving(bool serving);
  /// Reports "not serving", takes no more calls, and waits for those that run; after `patience`
  /// they are cancelled.
  void stop(std::chrono::milliseconds patience);

 private:
  struct Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::daemon
