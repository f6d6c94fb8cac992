#include "daemon/http/protocol/http_metrics.h"

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

}  // namespace

void HttpMetrics::count_request(const std::string& route, const std::string& method, int status) {
  const std::lock_guard lock(mutex_);
  ++requests_[{route, is_usual(method) ? method : "other", status}];
}

void HttpMetrics::count_refused_connection() {
  const std::lock_guard lock(mutex_);
  ++refused_connections_;
}

std::string HttpMetrics::text(int open_connections) const {
  const std::lock_guard lock(mutex_);
  std::string text =
      "# HELP hydroprint_http_connections Open connections.\n"
      "# TYPE hydroprint_http_connections gauge\n"
      "hydroprint_http_connections " +
      std::to_string(open_connections) +
      "\n# HELP hydroprint_http_connections_refused_total Connections refused because too many "
      "were open.\n"
      "# TYPE hydroprint_http_connections_refused_total counter\n"
      "hydroprint_http_connections_refused_total " +
      std::to_string(refused_connections_) +
      "\n# HELP hydroprint_http_requests_total Requests answered.\n"
      "# TYPE hydroprint_http_requests_total counter\n";
  for (const auto& [key, count] : requests_) {
    const auto& [route, method, status] = key;
    text += "hydroprint_http_requests_total{route=\"" + route + "\",method=\"" + method +
            "\",code=\"" + std::to_string(status) + "\"} " + std::to_string(count) + "\n";
  }
  return text;
}

}  // namespace hydroprint::http
