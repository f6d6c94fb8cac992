#include "daemon/http/protocol/connections.h"

namespace hydroprint::http {

bool Connections::add(const std::shared_ptr<Socket>& socket) {
  const std::lock_guard lock(mutex_);
  if (!is_over_) open_.insert(socket);
  return !is_over_;
}

void Connections::remove(const std::shared_ptr<Socket>& socket) {
  const std::lock_guard lock(mutex_);
  open_.erase(socket);
  removed_.notify_all();
}

int Connections::count() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(open_.size());
}

void Connections::close_all() {
  const std::lock_guard lock(mutex_);
  is_over_ = true;
  for (const auto& socket : open_) {
    socket->post([socket] { socket->close(); });
  }
}

bool Connections::wait_for_none(milliseconds patience) const {
  std::unique_lock lock(mutex_);
  return removed_.wait_for(lock, patience, [&] { return open_.empty(); });
}

}  // namespace hydroprint::http
