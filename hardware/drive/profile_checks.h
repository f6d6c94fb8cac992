#pragma once

#include "hardware/drive/profile.h"

namespace hydroprint {
class TomlReader;
}

namespace hydroprint::drive {

/// Refuses, at the key `block`, a block that cannot be read again after a bad reply
/// (block_parts.h).
void check_parts(TomlReader& top, const DriveProfile& profile);

/// Refuses, at the key `response_timeout_s`, a profile with which one lost reply would end a motion
/// (link_budget.h).
void check_budget(TomlReader& timing, const DriveProfile& profile);

}  // namespace hydroprint::drive
