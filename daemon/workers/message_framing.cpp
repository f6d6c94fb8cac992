#include "daemon/workers/message_framing.h"

#include <nlohmann/json.hpp>

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kLongestHead = 256 << 10;
constexpr int kDeepest = 16;

/// Returns the number of bytes that follow a head; nullopt if it is malformed. (Deeply nested text
/// would exhaust the parser's stack.)
std::optional<std::size_t> bytes_after(const std::string& head, std::size_t most) {
  int depth = 0;
  for (const char c : head) {
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth > kDeepest) return {};
  }
  const auto json = nlohmann::json::parse(head, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return {};
  const auto bytes = json.find("bytes");
  if (bytes == json.end() || !bytes->is_number_unsigned()) return {};
  const auto count = bytes->get<std::size_t>();
  return count <= most ? std::optional(count) : std::nullopt;
}

}  // namespace

Result<std::optional<FramedMessage>> cut_framed(std::string& read, std::size_t most) {
  const auto refusal = fail(Code::kInternal, "not a line of JSON with a number of bytes");
  const std::size_t end = read.find('\n');
  if (end == std::string::npos) {
    if (read.size() > kLongestHead) return refusal;
    return std::nullopt;
  }
  FramedMessage out{read.substr(0, end), {}};
  const auto count = bytes_after(out.head, most);
  if (!count) return refusal;
  if (read.size() - end - 1 < *count) return std::nullopt;
  out.bytes = read.substr(end + 1, *count);
  read.erase(0, end + 1 + *count);
  return out;
}

}  // namespace hydroprint::daemon
