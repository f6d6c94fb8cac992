#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <set>

#include "daemon/http/protocol/socket.h"

namespace hydroprint::http {

/// The open connections. Thread-safe.
class Connections {
 public:
  /// Adds a connection; returns false after close_all().
  [[nodiscard]] bool add(const std::shared_ptr<Socket>& socket);
  void remove(const std::shared_ptr<Socket>& socket);
  [[nodiscard]] int count() const;
  /// Closes all connections, as if their clients had disconnected.
  void close_all();
  /// Waits until all connections are removed; false on timeout.
  [[nodiscard]] bool wait_for_none(milliseconds patience) const;

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable removed_;
  std::set<std::shared_ptr<Socket>> open_;
  bool is_over_ = false;
};

}  // namespace hydroprint::http
