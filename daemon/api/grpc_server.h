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

/// Runs the services within the process, with the health service and, if enabled, reflection. Also
/// runs the gRPC endpoint, which authorizes calls and forwards them to the services
/// (call_forwarder.h).
class Server {
 public:
  /// Starts listening and answering calls.
  /// @param identity  TLS certificate and key; empty: without TLS
  /// @return kUnavailable if the address cannot be bound, usually because it is in use
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(const Endpoint& endpoint,
                                                             bool reflection,
                                                             const ServiceContext& backend,
                                                             tls::CurrentIdentity identity);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Returns a channel to the services for another endpoint, which must authorize its own calls.
  /// May outlive this object.
  [[nodiscard]] std::shared_ptr<grpc::Channel> in_process() const;
  /// Returns the role check that every endpoint makes before it calls the services.
  [[nodiscard]] const RoleCheck& roles() const;
  /// Returns the address on which the endpoint listens, with the actual port.
  [[nodiscard]] const Endpoint& endpoint() const;
  /// Sets the health status of the RigService; false at first.
  void set_rig_serving(bool serving);
  /// Reports "not serving", rejects new calls and waits for running calls. After `patience`,
  /// cancels the calls that still run.
  void stop(std::chrono::milliseconds patience);

 private:
  struct Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::daemon
