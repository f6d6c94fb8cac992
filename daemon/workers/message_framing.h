#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// A message of a resident process: a line of JSON, followed by as many bytes as its member "bytes"
/// announces.
struct FramedMessage {
  std::string head;
  std::string bytes;
};

/// Removes the first message from the bytes in `read`; nullopt if the message is still incomplete.
/// The bytes are untrusted, because the process may be compromised.
/// @param most  maximum number of announced bytes
/// @return kInternal for a malformed or too large message
[[nodiscard]] Result<std::optional<FramedMessage>> cut_framed(std::string& read, std::size_t most);

}  // namespace hydroprint::daemon
