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

/// Where and how to serve.
struct Options {
  std::string host;  ///< "127.0.0.1"
  int port = 0;      ///< 0: any
  /// By which browsers may call it, besides loopback's and those of its certificate.
  std::vector<std::string> host_names;
  std::filesystem::path web_dir;  ///< the web client's files; need not be there
  Limits limits;
  tls::CurrentIdentity identity;  ///< what clients are shown; none: TLS is not spoken
};

/// How the daemon is, as /healthz says it.
struct Health {
  bool is_good = true;
  std::string json;
};

/// Establishes the caller of an API method and checks its role (RoleCheck::admit). Never waits.
using Admit = std::function<Result<std::optional<auth::Caller>>(std::string_view method,
                                                                const auth::Credentials&)>;

/// What the server shows of the daemon. health and metrics may take their time: they are called by
/// a thread that does nothing else.
struct Sources {
  Admit admit;
  std::function<Health()> health;
  std::function<std::string()> metrics;  ///< Prometheus text
};

/// The HTTP front door: the services as JSON, their streams as server-sent events, uploads,
/// downloads, the web client's files. It never waits in a thread: whatever a client does, the next
/// one's request is served.
class Server {
 public:
  /// Listens and serves from here on.
  /// @param channel  to the services, in process
  /// @return kUnavailable if the address cannot be had; kInvalidArgument for a web client that is
  ///   too large
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(const Options& options,
                                                             std::shared_ptr<grpc::Channel> channel,
                                                             Sources sources);
  /// Stops if stop() was not called.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// The port it really listens at.
  [[nodiscard]] int port() const;
  /// Takes no more connections.
  void stop_accepting();
  /// Ends what is under way, in a second or so. The services must have ended their calls, or still
  /// answer.
  void stop();

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::http
