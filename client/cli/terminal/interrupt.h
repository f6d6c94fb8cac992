#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

namespace hydroprint::cli {

/// Converts the first Ctrl-C (or SIGTERM) to a stop request; a second one ends the program
/// immediately. Must be created before any other thread, so that all threads inherit the blocked
/// signals.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  void listen();

  sigset_t signals_{};
  std::stop_source stop_;
  std::thread listener_;
};

}  // namespace hydroprint::cli
