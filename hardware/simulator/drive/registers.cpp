#include "hardware/simulator/drive/registers.h"

#include "hardware/drive/word_codec.h"

namespace hydroprint::simulated_drive {
namespace {

using drive::Quantity;
using drive::Space;

int words_of(const drive::DriveProfile& profile, const drive::Write& write) {
  int words = 0;
  for (const drive::Value& value : write.values) words += drive::words_of(profile, value.quantity);
  return words;
}

}  // namespace

Registers::Registers(drive::DriveProfile profile, double watchdog_s, std::uint16_t watchdog_action)
    : profile_(std::move(profile)) {
  for (const drive::Block& block : profile_.blocks) {
    make(block.space, block.address, block.count);
    memory_[{block.space, block.mark.address}] = block.mark.value;
  }
  for (const auto& writes : profile_.commands) {
    for (const drive::Write& write : writes) {
      make(Space::kHolding, write.address, words_of(profile_, write));
    }
  }
  for (const drive::Mark& mark : profile_.identity)
    memory_[{mark.space, mark.address}] = mark.value;
  if (!profile_.watchdog) return;
  const auto& watchdog = *profile_.watchdog;
  make(watchdog.time.space, watchdog.time.address, watchdog.time.format.words);
  put(watchdog.time, watchdog_s);
  if (watchdog.action)
    memory_[{watchdog.action->space, watchdog.action->address}] = watchdog_action;
}

void Registers::make(Space space, std::uint16_t address, int words) {
  for (int i = 0; i < words; ++i) {
    memory_.try_emplace({space, static_cast<std::uint16_t>(address + i)}, 0);
  }
}

void Registers::put(const drive::Field& field, double value) {
  const auto words = drive::encode(field.format, value);
  // A value that cannot be encoded (out of range, or rounded to 0) is stored as 0.
  for (int i = 0; i < field.format.words; ++i) {
    memory_[{field.space, static_cast<std::uint16_t>(field.address + i)}] =
        words ? (*words)[static_cast<std::size_t>(i)] : std::uint16_t{0};
  }
}

void Registers::put_bit(drive::StatusBit which, bool value) {
  const auto& place = profile_.bit(which);
  if (!place) return;
  std::uint16_t& word = memory_[{place->space, place->address}];
  const unsigned mask = 1U << static_cast<unsigned>(place->bit);
  const bool set = value != place->inverted;
  word = static_cast<std::uint16_t>(set ? word | mask : word & ~mask);
}

void Registers::set_state(const drive::DriveState& state) {
  put(profile_.position, state.position_mm);
  if (profile_.velocity) put(*profile_.velocity, state.velocity_mm_per_s);
  if (profile_.demand) put(*profile_.demand, state.demand_mm.value_or(state.position_mm));
  put(profile_.alarm_code, state.alarm_code);
  put_bit(drive::StatusBit::kEnabled, state.enabled);
  put_bit(drive::StatusBit::kHomed, state.homed);
  put_bit(drive::StatusBit::kMoving, state.moving);
  put_bit(drive::StatusBit::kAlarm, state.alarm);
  put_bit(drive::StatusBit::kPositiveEnd, state.positive_end);
  put_bit(drive::StatusBit::kNegativeEnd, state.negative_end);
  put_bit(drive::StatusBit::kHomeSwitch, state.home_switch);
  put_bit(drive::StatusBit::kStopInput, state.stop_input);
}

std::optional<std::vector<std::uint16_t>> Registers::read(Space space, std::uint16_t address,
                                                          std::size_t count) const {
  std::vector<std::uint16_t> out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto word = memory_.find({space, static_cast<std::uint16_t>(address + i)});
    if (word == memory_.end() || address + i > 0xffff) return std::nullopt;
    out.push_back(word->second);
  }
  return out;
}

bool Registers::write(std::uint16_t address, std::span<const std::uint16_t> words) {
  if (!read(Space::kHolding, address, words.size())) return false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    memory_[{Space::kHolding, static_cast<std::uint16_t>(address + i)}] = words[i];
  }
  return true;
}

bool Registers::is_written(const drive::Write& write, std::uint16_t address,
                           std::span<const std::uint16_t> words) const {
  if (write.address != address || words_of(profile_, write) != static_cast<int>(words.size())) {
    return false;
  }
  std::size_t at = 0;
  for (const drive::Value& value : write.values) {
    if (value.quantity == Quantity::kWord && words[at] != value.word) return false;
    at += static_cast<std::size_t>(drive::words_of(profile_, value.quantity));
  }
  return true;
}

void Registers::take(const drive::Write& write, Order& order) const {
  std::uint16_t address = write.address;
  for (const drive::Value& value : write.values) {
    const int words = drive::words_of(profile_, value.quantity);
    const auto raw = read(Space::kHolding, address, static_cast<std::size_t>(words));
    if (value.quantity == Quantity::kPosition) {
      order.position_mm = drive::decode(profile_.position_format, *raw);
    } else if (value.quantity == Quantity::kSpeed) {
      order.speed_mm_per_s = drive::decode(profile_.speed_format, *raw);
    } else if (value.quantity == Quantity::kNegativeSpeed) {
      order.speed_mm_per_s = -drive::decode(profile_.speed_format, *raw);
    } else if (value.quantity == Quantity::kAcceleration) {
      order.acceleration_mm_per_s2 = drive::decode(profile_.acceleration_format, *raw);
    }
    address = static_cast<std::uint16_t>(address + words);
  }
}

std::optional<Order> Registers::order(std::uint16_t address,
                                      std::span<const std::uint16_t> words) const {
  for (std::size_t i = 0; i < drive::kCommands; ++i) {
    const auto& writes = profile_.commands.at(i);
    if (writes.empty() || !is_written(writes.back(), address, words)) continue;
    Order order;
    order.command = static_cast<drive::Command>(i);
    for (const drive::Write& write : writes) take(write, order);
    return order;
  }
  return std::nullopt;
}

double Registers::watchdog_s() const {
  if (!profile_.watchdog) return 0;
  const drive::Field& time = profile_.watchdog->time;
  const auto words = read(time.space, time.address, static_cast<std::size_t>(time.format.words));
  return drive::decode(time.format, *words);
}

WatchdogAction Registers::watchdog_action() const {
  if (!profile_.watchdog) return WatchdogAction::kNothing;
  const auto& watchdog = *profile_.watchdog;
  if (!watchdog.action) return WatchdogAction::kStop;
  const std::uint16_t action = memory_.at({watchdog.action->space, watchdog.action->address});
  for (const std::uint16_t stopping : watchdog.stopping) {
    if (action == stopping) return WatchdogAction::kStop;
  }
  return WatchdogAction::kNothing;
}

}  // namespace hydroprint::simulated_drive
