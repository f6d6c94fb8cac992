#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/auth/account.h"
#include "daemon/http/protocol/limits.h"
#include "daemon/tls/identity.h"
#include "sim/base/result.h"

namespace grpc {
class Channel;
}

namespace hydroprint::http {

/// Settings of the server.
struct Options {
  std::string host;  ///< "127.0.0.1"
  int port = 0;      ///< 0: any free port
  /// Further host names that browsers may use, in addition to loopback and the certificate's names.
  std::vector<std::string> host_names;
  std::filesystem::path web_dir;  ///< the web client's files; may be missing
  Limits limits;
  tls::CurrentIdentity identity;  ///< TLS certificate and key; empty: without TLS
};

/// Health of the daemon, returned by /healthz.
struct Health {
  bool is_good = true;
  std::string json;
};

/// Determines the caller of an API method and checks the caller's role (RoleCheck::admit). Never
/// waits.
using Admit = std::function<Result<std::optional<auth::Caller>>(std::string_view method,
                                                                const auth::Credentials&)>;

/// Functions that the daemon provides. health and metrics may block: they are called on a separate
/// thread.
struct Sources {
  Admit admit;
  std::function<Health()> health;
  std::function<std::string()> metrics;  ///< Prometheus text
};

/// The HTTP server. It offers the services as JSON, their streams as server-sent events, uploads,
/// downloads, and the web client's files. Connections never block a thread, so no client can delay
/// another.
class Server {
 public:
  /// Starts listening and serving.
  /// @param channel  in-process channel to the services
  /// @return kUnavailable if the address cannot be bound; kInvalidArgument if the web client is too
  /// large (StaticFiles::load)
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(const Options& options,
                                                             std::shared_ptr<grpc::Channel> channel,
                                                             Sources sources);
  /// Calls stop() if needed.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Returns the actual port.
  [[nodiscard]] int port() const;
  /// Stops accepting new connections.
  void stop_accepting();
  /// Ends running requests within about a second. By then the services must have ended their calls,
  /// or they must still be able to respond.
  void stop();

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::http
