#include "hardware/drive/state_decoder.h"

#include <span>

#include "hardware/drive/word_codec.h"

namespace hydroprint::drive {
namespace {

using Blocks = std::vector<std::vector<std::uint16_t>>;

bool holds(const Block& block, Space space, std::uint16_t address, int words) {
  return block.space == space && block.address <= address &&
         address + words <= block.address + block.count;
}

/// Returns the words at an address, which the profile check guarantees to be polled.
std::span<const std::uint16_t> words_at(const DriveProfile& profile, const Blocks& blocks,
                                        Space space, std::uint16_t address, int words) {
  std::size_t i = 0;
  while (!holds(profile.blocks[i], space, address, words)) ++i;
  return std::span(blocks[i]).subspan(address - profile.blocks[i].address,
                                      static_cast<std::size_t>(words));
}

}  // namespace

bool holds(const Block& block, const Field& field) {
  return holds(block, field.space, field.address, field.format.words);
}

DriveState decode_state(const DriveProfile& profile, const Blocks& blocks) {
  const auto number = [&](const Field& field) {
    return decode(field.format,
                  words_at(profile, blocks, field.space, field.address, field.format.words));
  };
  const auto bit = [&](StatusBit which) {
    const auto& place = profile.bit(which);
    if (!place) return false;
    const unsigned word = words_at(profile, blocks, place->space, place->address, 1)[0];
    return ((word >> static_cast<unsigned>(place->bit) & 1U) != 0) != place->inverted;
  };
  DriveState out;
  out.position_mm = number(profile.position);
  if (profile.velocity) out.velocity_mm_per_s = number(*profile.velocity);
  if (profile.demand) out.demand_mm = number(*profile.demand);
  out.enabled = bit(StatusBit::kEnabled);
  out.homed = bit(StatusBit::kHomed);
  out.moving = bit(StatusBit::kMoving);
  out.alarm = bit(StatusBit::kAlarm);
  out.positive_end = bit(StatusBit::kPositiveEnd);
  out.negative_end = bit(StatusBit::kNegativeEnd);
  out.home_switch = bit(StatusBit::kHomeSwitch);
  out.stop_input = bit(StatusBit::kStopInput);
  out.alarm_code = static_cast<int>(number(profile.alarm_code));
  if (out.alarm_code == 0) return out;
  const auto known = profile.alarms.find(out.alarm_code);
  out.alarm_text =
      known == profile.alarms.end() ? "alarm not listed in the profile" : known->second.text;
  out.alarm_hint =
      known == profile.alarms.end() ? "look the code up in the drive's manual" : known->second.hint;
  return out;
}

}  // namespace hydroprint::drive
