#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "daemon/api/service_context.h"
#include "daemon/config/config.h"
#include "daemon/tls/identity.h"

namespace grpc {
class Channel;
}

namespace hydroprint::daemon {

/// The gRPC server: the services, a health service and optional reflection.
class Server {
 public:
  /// Starts listening and answering calls.
  /// @param identity  TLS certificate and key; none: no TLS
  /// @return kUnavailable if the address cannot be bound, usually because another program uses it
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(const Endpoint& endpoint,
                                                             bool reflection,
                                                             const ServiceContext& backend,
                                                             tls::CurrentIdentity identity);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// A channel to the same services without a socket; may outlive this object.
  [[nodiscard]] std::shared_ptr<grpc::Channel> in_process() const;
  /// The address it listens on, with the actual port.
  [[nodiscard]] const Endpoint& endpoint() const;
  /// Sets the health status of the RigService; initially false.
  void set_rig_serving(bool serving);
  /// Reports "not serving", refuses new calls and waits for running ones; after `patience` they are
  /// cancelled.
  void stop(std::chrono::milliseconds patience);

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::daemon
