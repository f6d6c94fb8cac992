#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::client {

/// Metadata key of an error: all wrong fields of a request, one per line, if there are several.
inline constexpr const char* kWrongFields = "wrong_fields";

/// The address of a daemon, and the caller's identity.
struct ConnectionOptions {
  std::string server = "127.0.0.1:50051";  ///< "host:port" (ServerAddress::text())
  std::string owner;     ///< sent as the owner of new objects if there are no users; empty: none
  std::string api_key;   ///< "hp_ID_SECRET"; empty: none
  std::string session;   ///< token returned by sign_in(); empty: none
  std::stop_token stop;  ///< once requested, every call soon returns kCancelled
  bool is_tls = false;   ///< whether the server speaks TLS
  std::string ca_pem;    ///< certificates of the trusted authorities; empty: the system's
};

/// Returns kFailedPrecondition if a password or key would be sent to another machine without TLS,
/// where it could be read. Connections never send secrets that way; this function reports why.
[[nodiscard]] Status check_secrets_may_go(const ConnectionOptions& options);

/// A connection to one daemon, opened on first use and reopened when it breaks. The functions that
/// take a Connection may be called from several threads (jobs.h, rig.h, lease.h, assets.h,
/// artifacts.h, calibration.h, people.h, queue.h, health.h).
///
/// Calls that are safe to repeat are retried for about a second if the daemon does not respond.
/// Calls that create something carry a request_id, which makes them safe as well. After that they
/// return kUnavailable. Calls that move the rig are never repeated. Errors of the daemon keep their
/// code, message and reason.
class Connection {
 public:
  explicit Connection(ConnectionOptions options);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  [[nodiscard]] const ConnectionOptions& options() const;

  struct Impl;  ///< used only by this library's own .cpp files (rpc.h)
  [[nodiscard]] Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::client
