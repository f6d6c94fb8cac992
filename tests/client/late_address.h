#pragma once

#include <atomic>
#include <string>
#include <thread>

namespace hydroprint::tests {

/// An address where a daemon seems to start late: it closes the first connection and forwards the
/// others to a running daemon. How long a busy machine takes to start a daemon does not matter.
class LateAddress {
 public:
  /// @param daemon  its address, "127.0.0.1:40123"
  explicit LateAddress(const std::string& daemon);
  ~LateAddress();
  LateAddress(const LateAddress&) = delete;
  LateAddress& operator=(const LateAddress&) = delete;

  [[nodiscard]] const std::string& text() const { return text_; }
  /// Whether it has closed the first connection.
  [[nodiscard]] bool has_refused() const { return has_refused_; }

 private:
  void serve();

  std::string daemon_, text_;
  int listener_ = -1;
  std::atomic<bool> has_refused_ = false, is_over_ = false;
  std::thread thread_;
};

}  // namespace hydroprint::tests
