#pragma once

#include <string>

#include "daemon/api/service_context.h"
#include "daemon/metrics/job_metrics.h"
#include "daemon/tls/certificate_reloader.h"

namespace hydroprint::daemon {

/// The daemon as /healthz shows it.
struct HealthReport {
  bool is_good = true;  ///< it takes work: the store answers and nothing goes down
  std::string json;
};

/// Asks the store, so it may take its time. A rig or camera that is not there or wants help is told
/// and harms nothing else.
[[nodiscard]] HealthReport health_report(const ServiceContext& backend);

/// All figures but the HTTP server's, as Prometheus reads them. Asks the store.
/// @param certificate  null: there is none
[[nodiscard]] std::string metrics_text(const ServiceContext& backend, const JobMetrics& meter,
                                       const CertificateReloader* certificate);

}  // namespace hydroprint::daemon
