#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::client {

/// Key of an error's metadata: all wrong fields of a request, one a line, where there are several.
inline constexpr const char* kWrongFields = "wrong_fields";

/// Where the daemon is and who asks it.
struct ConnectionOptions {
  std::string server = "127.0.0.1:50051";  ///< "host:port" (ServerAddress::text())
  std::string owner;     ///< a name for what is created, where there are no users; empty: none
  std::string api_key;   ///< "hp_ID_SECRET"; empty: none
  std::string session;   ///< token that sign_in() gave; empty: none
  std::stop_token stop;  ///< once requested, every call ends soon with kCancelled
  bool is_tls = false;   ///< TLS is spoken there
  std::string ca_pem;    ///< certificates of the authorities to trust; empty: the system's
};

/// Refuses (kFailedPrecondition) to send a password or key, without TLS, to another machine:
/// anybody in between could read it. No connection does so; this says it.
[[nodiscard]] Status check_secrets_may_go(const ConnectionOptions& options);

/// A connection to one daemon, made on first use and made anew when it breaks. The functions that
/// take one (jobs.h, rig.h, lease.h, assets.h, artifacts.h, calibration.h, people.h, queue.h,
/// health.h) may be called from several threads.
///
/// Calls that may safely be repeated are repeated a few times, for about a second, when the daemon
/// does not answer; creating calls carry a request_id, which makes them safe as well. After that
/// they return kUnavailable. What moves the rig is never repeated. Errors of the daemon keep their
/// code, message and reason.
class Connection {
 public:
  explicit Connection(ConnectionOptions options);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  [[nodiscard]] const ConnectionOptions& options() const;

  struct Impl;  ///< of use to this library's own .cpp files only (rpc.h)
  [[nodiscard]] Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::client
