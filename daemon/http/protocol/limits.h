#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace hydroprint::http {

/// Limits of the HTTP server. Sizes and times apply to each connection.
struct Limits {
  std::uint32_t header_bytes = 16 << 10;
  std::size_t body_bytes = 1 << 20;  ///< limit for JSON bodies; uploads are not kept in memory
  std::chrono::milliseconds header_time{10'000};
  std::chrono::milliseconds idle_time{60'000};   ///< longest time between two requests
  std::chrono::milliseconds body_time{30'000};   ///< longest time between two pieces of a body
  std::chrono::milliseconds write_time{30'000};  ///< longest time for sending 64 KiB
  std::chrono::milliseconds call_time{30'000};   ///< timeout of a unary call
  std::chrono::milliseconds ping_time{15'000};   ///< idle time before a stream's keep-alive message
  int connections = 2000;
};

}  // namespace hydroprint::http
