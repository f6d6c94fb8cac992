#pragma once

#include <prometheus/registry.h>

#include <chrono>
#include <string>

namespace hydroprint::http {

/// Metrics of the HTTP server. Thread-safe.
class HttpMetrics {
 public:
  HttpMetrics();

  /// @param route  from a fixed set, never a client's text: "JobService/GetJob", "file"
  /// @param method  HTTP method; unusual methods are counted as "other"
  void count_request(const std::string& route, const std::string& method, int status);
  /// @param duration  from the request's header to the end of the response
  void observe_duration(const std::string& route, std::chrono::duration<double> duration);
  void count_refused_connection();
  /// Returns the metrics in Prometheus format.
  [[nodiscard]] std::string text(int open_connections) const;

 private:
  prometheus::Registry registry_;
  prometheus::Gauge& open_connections_;
  prometheus::Counter& refused_connections_;
  prometheus::Family<prometheus::Counter>& requests_;
  prometheus::Family<prometheus::Histogram>& durations_;
};

}  // namespace hydroprint::http
