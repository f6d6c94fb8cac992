#pragma once

#include <chrono>
#include <vector>

namespace hydroprint::cli {

/// What a key means where the axis is moved by keys.
enum class Key { kUp, kDown, kFaster, kSlower, kEnter, kQuit, kOther };

/// The keys of the terminal on standard input one by one, as they are pressed and without echo, for
/// as long as this lives. Ctrl-C still interrupts; Ctrl-Z and Ctrl-\ are keys as any other, since
/// who moves the axis must not be suspended. At most one at a time.
class Keyboard {
 public:
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// Whether standard input is a terminal.
  [[nodiscard]] static bool is_there();

  /// The keys pressed, in their order, as soon as there are any; none once `limit` is over.
  [[nodiscard]] std::vector<Key> read(std::chrono::milliseconds limit);
  /// Forgets the keys pressed but not read yet.
  static void forget();
  /// True once the terminal is closed.
  [[nodiscard]] bool gone() const { return gone_; }

 private:
  bool gone_ = false;
};

/// Puts the terminal back as it was before a Keyboard changed it, if one did: for whoever ends the
/// program without ending its objects.
void restore_terminal();

}  // namespace hydroprint::cli
