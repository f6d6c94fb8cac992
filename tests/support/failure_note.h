#pragma once

#include <functional>
#include <string>

namespace hydroprint::testing {

/// While it exists, the first failure of a test prints this text on stderr: the state of a program
/// at the moment of the failure. If an exception ends the test, the destructor prints it.
class FailureNote {
 public:
  /// @param text  called in any thread; must contain no assertions. Its exceptions are printed.
  explicit FailureNote(std::function<std::string()> text);
  ~FailureNote();
  FailureNote(const FailureNote&) = delete;
  FailureNote& operator=(const FailureNote&) = delete;

 private:
  std::function<std::string()> text_;
  int exceptions_;  ///< number of exceptions in flight at construction
};

/// The last lines of a text.
[[nodiscard]] std::string last_lines(const std::string& text, int count);

}  // namespace hydroprint::testing
