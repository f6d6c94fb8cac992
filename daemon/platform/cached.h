#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>

namespace hydroprint::daemon {

/// A value shared by many readers and recomputed at most once per period. Thread-safe.
template <class T>
class Cached {
 public:
  Cached(std::function<T()> make, std::chrono::milliseconds lasts)
      : make_(std::move(make)), lasts_(lasts) {}

  [[nodiscard]] std::shared_ptr<const T> get() {
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (!value_ || now - made_ >= lasts_) {
      value_ = std::make_shared<const T>(make_());
      made_ = now;
    }
    return value_;
  }

 private:
  std::function<T()> make_;
  std::chrono::milliseconds lasts_;
  std::mutex mutex_;
  std::shared_ptr<const T> value_;
  std::chrono::steady_clock::time_point made_;
};

}  // namespace hydroprint::daemon
