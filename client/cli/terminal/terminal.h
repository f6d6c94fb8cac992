#pragma once

#include <chrono>
#include <vector>

namespace hydroprint::cli {

/// The meaning of a key in interactive control of the axis.
enum class Key { kUp, kDown, kFaster, kSlower, kEnter, kQuit, kOther };

/// Reads single keys without echo from the terminal on standard input during its lifetime. Ctrl-C
/// still interrupts. Ctrl-Z and Ctrl-\ are ordinary keys, because a program that moves the axis
/// must not be suspended. At most one instance at a time.
class Keyboard {
 public:
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// Returns whether standard input is a terminal.
  [[nodiscard]] static bool is_there();

  /// Waits for keys and returns those pressed, in order; empty after `limit`.
  [[nodiscard]] std::vector<Key> read(std::chrono::milliseconds limit);
  /// Discards keys that were pressed but not yet read.
  static void forget();
  /// Returns true once the terminal is closed.
  [[nodiscard]] bool gone() const { return gone_; }

 private:
  bool gone_ = false;
};

/// Restores the terminal settings that a Keyboard changed. For exits that do not run destructors.
void restore_terminal();

}  // namespace hydroprint::cli
