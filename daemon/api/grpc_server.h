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

/// The gRPC server: the services, health for each of them, reflection if wanted.
class Server {
 public:
  /// Listens; calls are answered from here on.
  /// @param identity  what clients are shown; none: TLS is not spoken
  /// @return kUnavailable if the address cannot be had, above all because something else has it
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(const Endpoint& endpoint,
                                                             bool reflection,
                                                             const ServiceContext& backend,
                                                             tls::CurrentIdentity identity);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// A way to the same services without a socket; may outlive this.
  [[nodiscard]] std::shared_ptr<grpc::Channel> in_process() const;
  /// Where it listens, with the real port.
  [[nodiscard]] const Endpoint& endpoint() const;
  /// What health says of the RigService; false at first.
  void set_rig_serving(bool serving);
  /// Reports "not serving", takes no more calls, and waits for those that run; after `patience`
  /// they are broken off.
  void stop(std::chrono::milliseconds patience);

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::daemon
