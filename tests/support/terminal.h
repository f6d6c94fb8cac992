#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace hydroprint::testing {

/// A program running on its own terminal.
class Terminal {
 public:
  explicit Terminal(std::vector<std::string> arguments);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Types keys.
  void type(const std::string& keys) const;
  /// Repeats a key, as a keyboard does while the key is held.
  void hold(const std::string& key, std::chrono::milliseconds time,
            std::chrono::milliseconds repeat = std::chrono::milliseconds(30));
  /// Waits until `words` appear after the words found by the previous call; false after `limit`.
  [[nodiscard]] bool shows(const std::string& words,
                           std::chrono::milliseconds limit = std::chrono::seconds(20));
  /// Waits for the program to end. Returns its exit status, or -1 after `limit`.
  int wait(std::chrono::seconds limit = std::chrono::seconds(20));
  /// True if the terminal echoes input and passes it by lines, as a shell expects.
  [[nodiscard]] bool is_cooked() const;

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// All output so far.
  [[nodiscard]] const std::string& screen() const { return screen_; }

 private:
  void look(std::chrono::milliseconds limit);

  int master_ = -1;
  pid_t pid_ = -1;
  std::optional<int> status_;
  std::string screen_;
  std::size_t seen_ = 0;
};

}  // namespace hydroprint::testing
