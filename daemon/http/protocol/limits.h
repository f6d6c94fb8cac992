#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace hydroprint::http {

/// How much of everything a client may have.
struct Limits {
  std::uint32_t header_bytes = 16 << 10;
  std::size_t body_bytes = 1 << 20;  ///< of a JSON body; uploads are not kept in memory
  std::chrono::milliseconds header_time{10'000};
  std::chrono::milliseconds idle_time{60'000};   ///< between requests
  std::chrono::milliseconds body_time{30'000};   ///< from one piece of a body to the next
  std::chrono::milliseconds write_time{30'000};  ///< for 64 KiB to get away
  std::chrono::milliseconds call_time{30'000};   ///< for an answer of the services
  std::chrono::milliseconds ping_time{15'000};   ///< from one sign of life in a stream to the next
  int connections = 2000;
};

}  // namespace hydroprint::http
