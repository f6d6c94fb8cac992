#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace hydroprint::testing {

/// A program run at a terminal of its own, as a person sees it.
class Terminal {
 public:
  explicit Terminal(std::vector<std::string> arguments);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Presses keys.
  void type(const std::string& keys) const;
  /// Presses a key again and again, as a keyboard does while it is held.
  void hold(const std::string& key, std::chrono::milliseconds time,
            std::chrono::milliseconds repeat = std::chrono::milliseconds(30));
  /// Waits until these words appeared since the last of this that was found; false after `limit`.
  [[nodiscard]] bool shows(const std::string& words,
                           std::chrono::milliseconds limit = std::chrono::seconds(20));
  /// Waits for the end; exit status, -1 if it does not end within `limit`.
  int wait(std::chrono::seconds limit = std::chrono::seconds(20));
  /// Whether what is typed is shown and comes by lines, as a shell wants it.
  [[nodiscard]] bool is_cooked() const;

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// All that was shown.
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
