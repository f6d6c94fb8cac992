#pragma once

#include <cstdint>
#include <vector>

#include "hardware/drive/profile.h"

namespace hydroprint::drive {

/// Some of the registers of a block, read with one request.
struct Part {
  std::uint16_t address = 0;
  std::uint16_t count = 0;
};

/// Returns the requests that read a block again after a bad reply: two that halve it somewhere, or
/// else one with only the registers that the profile uses. No part has as many words as a block of
/// the profile or as the other part, so a late reply to an earlier request is not taken for one of
/// these. No part separates the words of a number, or position from velocity. At best, parts are
/// also longer than the requests for identity and watchdog. Returns an empty list if no division
/// meets these conditions.
[[nodiscard]] std::vector<Part> parts_of(const DriveProfile& profile, const Block& block);

}  // namespace hydroprint::drive
