#include "daemon/workers/message_framing.h"

#include "sim/base/checked_json.h"

namespace hydroprint::daemon {
namespace {

constexpr JsonLimits kHeadLimits{256 << 10, 16};

}  // namespace

Result<std::optional<FramedMessage>> cut_framed(std::string& read, std::size_t most) {
  const auto refusal =
      fail(Code::kInternal, "the message header is not a JSON line with a valid byte count");
  const std::size_t end = read.find('\n');
  if (end == std::string::npos) {
    if (read.size() > kHeadLimits.bytes) return refusal;
    return std::nullopt;
  }
  FramedMessage out{read.substr(0, end), {}};
  const auto count = json_unsigned(parse_json(out.head, kHeadLimits).value_or(nullptr), "bytes");
  if (!count || *count > most) return refusal;
  if (read.size() - end - 1 < *count) return std::nullopt;
  out.bytes = read.substr(end + 1, *count);
  read.erase(0, end + 1 + *count);
  return out;
}

}  // namespace hydroprint::daemon
