#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "daemon/platform/clock.h"
#include "daemon/platform/prometheus_text.h"
#include "daemon/tls/identity.h"
#include "sim/base/process/periodic_thread.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// The certificate that both doors show. Looks every two seconds whether its files changed: a pair
/// that can be used counts from the next connection on, one that cannot is logged, and the one
/// before stays. Logs once a day that it has expired or soon will.
class CertificateReloader {
 public:
  /// @return what tls::Identity::read() refuses
  [[nodiscard]] static Result<std::unique_ptr<CertificateReloader>> open(
      const std::filesystem::path& certificate_file, const std::filesystem::path& key_file,
      Clock clock);

  /// The pair that counts now. Any thread may call.
  [[nodiscard]] std::shared_ptr<const tls::Identity> current() const;
  /// When it expires, as a figure.
  void describe(PrometheusText& out) const;

 private:
  /// What tells a file from another one of its name; none: it is not there.
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
  Stamps loaded_;        // the thread's own from here, once it runs
  std::string refused_;  // what was last logged of a pair that cannot be used
  std::int64_t warn_next_ms_ = 0;
  mutable std::mutex mutex_;
  std::shared_ptr<const tls::Identity> current_;
  std::optional<PeriodicThread> thread_;
};

}  // namespace hydroprint::daemon
