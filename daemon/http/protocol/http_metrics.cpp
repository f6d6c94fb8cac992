#include "daemon/http/protocol/http_metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace hydroprint::http {
namespace {

bool is_usual(const std::string& method) {
  static constexpr std::array<std::string_view, 7> kUsual{"GET",   "HEAD",   "POST",   "PUT",
                                                          "PATCH", "DELETE", "OPTIONS"};
  return std::find(kUsual.begin(), kUsual.end(), method) != kUsual.end();
}

prometheus::Histogram::BucketBoundaries duration_buckets_s() {
  return {0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 60};
}

}  // namespace

HttpMetrics::HttpMetrics()
    : open_connections_(prometheus::BuildGauge()
                            .Name("hydroprint_http_connections")
                            .Help("Open connections.")
                            .Register(registry_)
                            .Add({})),
      refused_connections_(prometheus::BuildCounter()
                               .Name("hydroprint_http_connections_refused_total")
                               .Help("Connections refused because too many were open.")
                               .Register(registry_)
                               .Add({})),
      requests_(prometheus::BuildCounter()
                    .Name("hydroprint_http_requests_total")
                    .Help("Requests answered.")
                    .Register(registry_)),
      durations_(prometheus::BuildHistogram()
                     .Name("hydroprint_http_request_duration_seconds")
                     .Help("Time from a request's header to the end of its response.")
                     .Register(registry_)) {}

void HttpMetrics::count_request(const std::string& route, const std::string& method, int status) {
  requests_
      .Add({{"route", route},
            {"method", is_usual(method) ? method : "other"},
            {"code", std::to_string(status)}})
      .Increment();
}

void HttpMetrics::observe_duration(const std::string& route,
                                   std::chrono::duration<double> duration) {
  durations_.Add({{"route", route}}, duration_buckets_s()).Observe(duration.count());
}

void HttpMetrics::count_refused_connection() { refused_connections_.Increment(); }

std::string HttpMetrics::text(int open_connections) const {
  open_connections_.Set(open_connections);
  return prometheus::TextSerializer().Serialize(registry_.Collect());
}

}  // namespace hydroprint::http
