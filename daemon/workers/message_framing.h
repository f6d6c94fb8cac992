#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// What a process of ours that stays says again and again: a line of JSON, and the bytes that it
/// announces ("bytes").
struct FramedMessage {
  std::string head;
  std::string bytes;
};

/// Takes the first whole one off what was read; none: more has to come. What comes may be a
/// stranger's who took the process over.
/// @param most  bytes that one may announce
/// @return kInternal for what is none, or is too large
[[nodiscard]] Result<std::optional<FramedMessage>> cut_framed(std::string& read, std::size_t most);

}  // namespace hydroprint::daemon
