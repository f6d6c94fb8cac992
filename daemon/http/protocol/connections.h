#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <set>

#include "daemon/http/protocol/socket.h"

namespace hydroprint::http {

/// The connections that are open. Any thread may call.
class Connections {
 public:
  /// False after close_all().
  [[nodiscard]] bool add(const std::shared_ptr<Socket>& socket);
  void remove(const std::shared_ptr<Socket>& socket);
  [[nodiscard]] int count() const;
  /// Ends all, as if their clients had gone.
  void close_all();
  /// Whether all were removed in time.
  [[nodiscard]] bool wait_for_none(milliseconds patience) const;

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable removed_;
  std::set<std::shared_ptr<Socket>> open_;
  bool is_over_ = false;
};

}  // namespace hydroprint::http
