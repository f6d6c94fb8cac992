#pragma once

#include <string>

#include "daemon/api/service_context.h"
#include "daemon/metrics/job_metrics.h"
#include "daemon/tls/certificate_reloader.h"

namespace hydroprint::daemon {

/// The content of /healthz.
struct HealthReport {
  bool is_good = true;  ///< the store responds and the daemon is not shutting down
  std::string json;
};

/// Creates the health report. Reads the store, so it may take time. Faults of the rig and the
/// camera are reported, but do not make the daemon unhealthy.
[[nodiscard]] HealthReport health_report(const ServiceContext& backend);

/// Returns all metrics except the HTTP server's, in Prometheus format. Reads the store.
/// @param certificate  null without TLS
[[nodiscard]] std::string metrics_text(const ServiceContext& backend, const JobMetrics& meter,
                                       const CertificateReloader* certificate);

}  // namespace hydroprint::daemon
