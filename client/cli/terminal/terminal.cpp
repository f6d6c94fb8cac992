#include "client/cli/terminal/terminal.h"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <mutex>
#include <optional>
#include <string_view>

namespace hydroprint::cli {
namespace {

std::mutex before_mutex;
std::optional<termios> before;  // settings before the first Keyboard

bool skip(std::string_view& text, std::string_view start) {
  if (!text.starts_with(start)) return false;
  text.remove_prefix(start.size());
  return true;
}

Key take_key(std::string_view& text) {
  if (skip(text, "\x1b[A") || skip(text, "\x1bOA")) return Key::kUp;
  if (skip(text, "\x1b[B") || skip(text, "\x1bOB")) return Key::kDown;
  const char c = text.front();
  text.remove_prefix(1);
  switch (c) {
    case 'k':
      return Key::kUp;
    case 'j':
      return Key::kDown;
    case '+':
      return Key::kFaster;
    case '-':
      return Key::kSlower;
    case '\n':
    case '\r':
      return Key::kEnter;
    case 'q':
      return Key::kQuit;
    default:
      return Key::kOther;
  }
}

}  // namespace

Keyboard::Keyboard() {
  const std::lock_guard lock(before_mutex);
  termios now{};
  if (tcgetattr(STDIN_FILENO, &now) != 0) return;
  before = now;
  now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  now.c_cc[VMIN] = 0;
  now.c_cc[VTIME] = 0;
  now.c_cc[VSUSP] = now.c_cc[VQUIT] = _POSIX_VDISABLE;
  tcsetattr(STDIN_FILENO, TCSAFLUSH, &now);
}

Keyboard::~Keyboard() { restore_terminal(); }

bool Keyboard::is_there() { return isatty(STDIN_FILENO) == 1; }

std::vector<Key> Keyboard::read(std::chrono::milliseconds limit) {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (poll(&input, 1, static_cast<int>(limit.count())) <= 0) return {};
  std::array<char, 256> bytes{};
  const auto count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  gone_ = count <= 0;
  std::vector<Key> keys;
  if (gone_) return keys;
  for (std::string_view text(bytes.data(), static_cast<std::size_t>(count)); !text.empty();)
    keys.push_back(take_key(text));
  return keys;
}

void Keyboard::forget() { tcflush(STDIN_FILENO, TCIFLUSH); }

void restore_terminal() {
  const std::lock_guard lock(before_mutex);
  if (before) tcsetattr(STDIN_FILENO, TCSAFLUSH, &*before);
  before.reset();
}

}  // namespace hydroprint::cli
