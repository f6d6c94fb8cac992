#include "client/cli/terminal/secret.h"

#include <termios.h>
#include <unistd.h>

#include <iostream>

namespace hydroprint::cli {
namespace {

constexpr char kCtrlC = 3;

// Disables the terminal's echo during its lifetime. Ctrl-C ends the input line: ending the program
// would leave the echo disabled.
class Unseen {
 public:
  Unseen() {
    if (tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios now = before_;
    now.c_lflag &= ~static_cast<tcflag_t>(ECHO | ISIG);
    now.c_cc[VEOL] = kCtrlC;
    changed_ = tcsetattr(STDIN_FILENO, TCSAFLUSH, &now) == 0;
  }
  ~Unseen() {
    if (!changed_) return;
    tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
    std::cerr << std::endl;
  }
  Unseen(const Unseen&) = delete;
  Unseen& operator=(const Unseen&) = delete;

 private:
  termios before_{};
  bool changed_ = false;
};

bool is_asked() { return isatty(STDIN_FILENO) == 1; }

// Reads byte by byte: std::getline would wait for the rest of a line that ended with Ctrl-C.
Result<std::string> read_line() {
  std::string line;
  for (char c = 0;;) {
    const auto count = ::read(STDIN_FILENO, &c, 1);
    if (count == 1 && c == kCtrlC) return fail(Code::kCancelled, "interrupted");
    if (count != 1 && line.empty()) {
      return fail(Code::kInvalidArgument,
                  "standard input ended before the expected line; provide one line");
    }
    if (count != 1 || c == '\n') return line;
    line += c;
  }
}

}  // namespace

Result<std::string> ask(const std::string& prompt) {
  if (is_asked()) std::cerr << prompt << std::flush;
  return read_line();
}

Result<std::string> ask_secret(const std::string& prompt) {
  if (!is_asked()) return read_line();
  const Unseen unseen;
  std::cerr << prompt << std::flush;
  return read_line();
}

Result<std::string> ask_new_password() {
  HP_ASSIGN_OR_RETURN(std::string password, ask_secret("New password: "));
  if (!is_asked()) return password;
  HP_ASSIGN_OR_RETURN(const std::string again, ask_secret("Repeat password: "));
  if (again != password) return fail(Code::kInvalidArgument, "the passwords differ; try again");
  return password;
}

}  // namespace hydroprint::cli
