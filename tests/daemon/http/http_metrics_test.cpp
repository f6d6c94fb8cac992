#include "daemon/http/protocol/http_metrics.h"

#include <gtest/gtest.h>

namespace hydroprint::http {
namespace {

bool has(const HttpMetrics& metrics, const std::string& line) {
  return metrics.text(0).find("\n" + line + "\n") != std::string::npos;
}

TEST(HttpMetrics, DurationsAreAHistogramByRoute) {
  HttpMetrics metrics;
  metrics.observe_duration("file", std::chrono::microseconds(1500));
  metrics.observe_duration("file", std::chrono::seconds(2));
  const std::string name = "hydroprint_http_request_duration_seconds";
  EXPECT_TRUE(has(metrics, "# TYPE " + name + " histogram"));
  EXPECT_TRUE(has(metrics, name + "_bucket{route=\"file\",le=\"0.001\"} 0"));
  EXPECT_TRUE(has(metrics, name + "_bucket{route=\"file\",le=\"0.0025\"} 1"));
  EXPECT_TRUE(has(metrics, name + "_bucket{route=\"file\",le=\"+Inf\"} 2"));
  EXPECT_TRUE(has(metrics, name + "_sum{route=\"file\"} 2.0015"));
}

TEST(HttpMetrics, UnusualMethodsCountAsOther) {
  HttpMetrics metrics;
  metrics.count_request("file", "BREW", 405);
  metrics.count_request("file", "POUR", 405);
  EXPECT_TRUE(has(
      metrics, "hydroprint_http_requests_total{code=\"405\",method=\"other\",route=\"file\"} 2"));
}

TEST(HttpMetrics, RefusedConnectionsAreZeroAtFirst) {
  HttpMetrics metrics;
  EXPECT_TRUE(has(metrics, "hydroprint_http_connections_refused_total 0"));
  metrics.count_refused_connection();
  EXPECT_TRUE(has(metrics, "hydroprint_http_connections_refused_total 1"));
}

}  // namespace
}  // namespace hydroprint::http
