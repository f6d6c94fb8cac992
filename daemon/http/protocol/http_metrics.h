#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

namespace hydroprint::http {

/// What the server counts of itself. Any thread may call.
class HttpMetrics {
 public:
  /// @param route  of a fixed set, never what a client sent: "JobService/GetJob", "file"
  /// @param method  any that is no usual one counts as "other"
  void count_request(const std::string& route, const std::string& method, int status);
  void count_refused_connection();
  /// As Prometheus has it.
  [[nodiscard]] std::string text(int open_connections) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::tuple<std::string, std::string, int>, std::uint64_t> requests_;
  std::uint64_t refused_connections_ = 0;
};

}  // namespace hydroprint::http
