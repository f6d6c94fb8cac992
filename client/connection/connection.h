#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::client {

/// Key in the metadata of an error that lists all wrong fields of a request, as
/// "FIELD<tab>PROBLEM", one per line, if there are several.
inline constexpr const char* kWrongFields = "wrong_fields";

/// The address of a daemon, and the caller's identity.
struct ConnectionOptions {
  std::string server = "127.0.0.1:50051";  ///< "host:port" (ServerAddress::text())
  std::string owner;     ///< owner of new objects if the daemon has no users; empty: none
  std::string api_key;   ///< "hp_ID_SECRET"; empty: none
  std::string session;   ///< token returned by sign_in(); empty: none
  std::stop_token stop;  ///< once a stop is requested, every call soon returns kCancelled
  bool is_tls = false;   ///< whether the server speaks TLS
  std::string ca_pem;    ///< certificates of the trusted authorities; empty: the system's
};

/// Returns kFailedPrecondition if the server is another machine and the connection does not use
/// TLS, because a password or key could then be read on the way. A Connection never sends them in
/// that case; this error explains why.
[[nodiscard]] Status check_secrets_may_go(const ConnectionOptions& options);

/// A connection to one daemon, opened on first use and reopened when it breaks. The functions with
/// a Connection parameter may be called from several threads. If the daemon does not respond, calls
/// that are safe to repeat are retried for about a second, then return kUnavailable. Calls that
/// create a job, upload, calibration or lease are also safe, because they carry a request_id. Calls
/// that move the rig, sign in, or change users, keys or sessions are never repeated. Errors of the
/// daemon keep their code, message and reason.
class Connection {
 public:
  explicit Connection(ConnectionOptions options);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  [[nodiscard]] const ConnectionOptions& options() const;

  struct Impl;  ///< used only by .cpp files of this library (rpc.h)
  [[nodiscard]] Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::client
