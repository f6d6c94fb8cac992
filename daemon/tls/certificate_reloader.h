#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "daemon/platform/clock.h"
#include "daemon/tls/identity.h"
#include "sim/base/process/periodic_thread.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// The certificate of the gRPC and HTTP servers. Checks its files every two seconds. A valid new
/// pair applies to all later connections. An invalid pair is logged, and the previous pair remains
/// in use. Logs once a day if the certificate has expired or expires within 14 days.
class CertificateReloader {
 public:
  /// @return errors of tls::Identity::read()
  [[nodiscard]] static Result<std::unique_ptr<CertificateReloader>> open(
      const std::filesystem::path& certificate_file, const std::filesystem::path& key_file,
      Clock clock);

  /// Returns the current pair. Thread-safe.
  [[nodiscard]] std::shared_ptr<const tls::Identity> current() const;

 private:
  /// Identifies a version of a file; nullopt if the file does not exist.
  using Stamp = std::optional<std::array<std::int64_t, 5>>;
  using Stamps = std::array<Stamp, 2>;

  CertificateReloader(std::filesystem::path certificate_file, std::filesystem::path key_file,
                      Clock clock);
  [[nodiscard]] Stamps stamps() const;
  [[nodiscard]] Status load();
  void look_again();
  void warn_of_expiry();

  std::filesystem::path certificate_file_, key_file_;
  Clock clock_;
  Stamps loaded_;        // after open(), only the thread uses this and the next two members
  std::string refused_;  // last logged error; empty if the last pair read was valid
  std::int64_t warn_next_ms_ = 0;
  mutable std::mutex mutex_;
  std::shared_ptr<const tls::Identity> current_;
  std::optional<PeriodicThread> thread_;
};

}  // namespace hydroprint::daemon
