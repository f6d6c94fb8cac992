#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

namespace hydroprint::http {

/// The server's own metrics. Thread-safe.
class HttpMetrics {
 public:
  /// @param route   from a fixed set, never text from a client: "JobService/GetJob", "file"
  /// @param method  unknown methods count as "other"
  void count_request(const std::string& route, const std::string& method, int status);
  void count_refused_connection();
  /// Returns the metrics in Prometheus format.
  [[nodiscard]] std::string text(int open_connections) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::tuple<std::string, std::string, int>, std::uint64_t> requests_;
  std::uint64_t refused_connections_ = 0;
};

}  // namespace hydroprint::http
