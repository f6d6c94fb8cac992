#include "hardware/drive/profile.h"

#include <algorithm>
#include <cmath>

#include "hardware/drive/pdu.h"
#include "hardware/drive/profile_checks.h"
#include "hardware/drive/profile_fields.h"
#include "hardware/drive/word_codec.h"
#include "sim/base/toml_reader.h"

namespace hydroprint::drive {
namespace {

constexpr std::array<std::string_view, kStatusBits> kBitNames = {
    "enabled",      "homed",        "moving",      "alarm",
    "positive_end", "negative_end", "home_switch", "stop_input"};
constexpr std::array<std::string_view, kCommands> kCommandNames = {
    "enable", "disable", "home", "move", "jog_positive", "jog_negative", "stop", "reset_fault"};
constexpr std::array<std::string_view, 5> kQuantityNames = {"position", "speed", "-speed",
                                                            "acceleration", "deceleration"};

Mark read_mark(TomlReader& table, Space space) {
  Mark mark{space, read_word(table, "address"), read_word(table, "value"),
            read_word(table, "mask", 0xffff), table.text("meaning", "mark")};
  if (mark.mask == 0 || (mark.value & ~mark.mask) != 0) {
    table.refuse("mask", "is 0 or omits bits of the value. Set these bits in the mask");
  }
  return mark;
}

void check_mark(const Block& block, TomlReader& mark) {
  if (block.mark.address < block.address || block.mark.address >= block.address + block.count) {
    mark.refuse("address", "is outside its block. Use a register of the block");
  }
}

std::vector<Block> read_blocks(TomlReader& top) {
  std::vector<Block> blocks;
  for (TomlReader& table : top.tables("block")) {
    Block block;
    block.space = read_space(table);
    block.address = read_word(table, "address");
    // At least three words: identity and watchdog are read with requests of one or two, and the
    // lengths of replies must differ.
    block.count = static_cast<std::uint16_t>(table.integer("count", 3, kMaxReadWords));
    if (block.address + block.count > 0x10000) {
      table.refuse("count",
                   "is too large: the block ends after register 65535. Use a smaller count");
    }
    TomlReader mark = table.table("mark");
    block.mark = read_mark(mark, block.space);
    check_mark(block, mark);
    if (std::any_of(blocks.begin(), blocks.end(),
                    [&](const Block& other) { return other.count == block.count; })) {
      table.refuse("count",
                   "is the same as that of another block, so late replies could be confused. Read "
                   "one more register in one of the blocks");
    }
    blocks.push_back(std::move(block));
  }
  if (blocks.empty()) top.refuse("block", "is empty. Add a block with the registers to poll");
  return blocks;
}

bool is_polled(const std::vector<Block>& blocks, Space space, std::uint16_t address, int words) {
  return std::any_of(blocks.begin(), blocks.end(), [&](const Block& block) {
    return block.space == space && block.address <= address &&
           address + words <= block.address + block.count;
  });
}

Field read_polled(TomlReader& top, const std::vector<Block>& blocks, std::string_view key,
                  std::string_view per_unit) {
  Field field = read_field(top.table(key), per_unit);
  if (!is_polled(blocks, field.space, field.address, field.format.words)) {
    top.refuse(key, "is not in any block. Extend a block, or add one");
  }
  return field;
}

void read_alarms(TomlReader& top, DriveProfile& profile) {
  TomlReader code = top.table("alarm_code");
  profile.alarm_code.space = read_space(code);
  profile.alarm_code.address = read_word(code, "address");
  if (!is_polled(profile.blocks, profile.alarm_code.space, profile.alarm_code.address, 1)) {
    top.refuse("alarm_code", "is not in any block. Extend a block, or add one");
  }
  if (!top.has("alarm")) return;
  for (TomlReader& table : top.tables("alarm")) {
    const int number = static_cast<int>(table.integer("code", 1, 0xffff));
    Alarm alarm{table.text("text"), table.text("hint")};
    if (!profile.alarms.emplace(number, std::move(alarm)).second) {
      table.refuse("code", "is used by two alarms. Remove one of them");
    }
  }
}

void read_bits(TomlReader& top, DriveProfile& profile) {
  TomlReader status = top.table("status");
  for (std::size_t i = 0; i < kStatusBits; ++i) {
    const std::string_view name = kBitNames.at(i);
    const bool required = i <= static_cast<std::size_t>(StatusBit::kAlarm);
    if (!required && !status.has(name)) continue;
    TomlReader table = status.table(name);
    BitPlace place;
    place.space = read_space(table);
    place.address = read_word(table, "address");
    place.bit = static_cast<int>(table.integer("bit", 0, 15));
    place.inverted = table.flag("inverted", false);
    if (!is_polled(profile.blocks, place.space, place.address, 1)) {
      status.refuse(name, "is not in any block. Extend a block, or add one");
    }
    profile.bits.at(i) = place;
  }
}

std::optional<Value> read_value(const toml::node& node) {
  if (const auto* word = node.as_integer()) {
    if (word->get() < 0 || word->get() > 0xffff) return std::nullopt;
    return Value{Quantity::kWord, static_cast<std::uint16_t>(word->get())};
  }
  const auto* name = node.as_string();
  if (name == nullptr) return std::nullopt;
  const auto* found = std::find(kQuantityNames.begin(), kQuantityNames.end(), name->get());
  if (found == kQuantityNames.end()) return std::nullopt;
  return Value{static_cast<Quantity>(found - kQuantityNames.begin() + 1), 0};
}

Write read_write(TomlReader& table, const DriveProfile& profile) {
  Write write;
  write.address = read_word(table, "address");
  int words = 0;
  for (const toml::node* node : table.array("values")) {
    const auto value = read_value(*node);
    if (!value) {
      table.refuse("values",
                   "contains an invalid value. Use words from 0 to 65535 and \"position\", "
                   "\"speed\", \"-speed\", \"acceleration\", \"deceleration\"");
      return write;
    }
    words += words_of(profile, value->quantity);
    write.values.push_back(*value);
  }
  if (words < 1 || words > kMaxWriteWords || write.address + words > 0x10000) {
    table.refuse(
        "values",
        "contains too few or too many words, or ends after register 65535. Use 1 to 123 words");
  }
  return write;
}

void read_commands(TomlReader& top, DriveProfile& profile) {
  TomlReader formats = top.table("write");
  const auto format = [&](std::string_view name, std::string_view per_unit) {
    TomlReader table = formats.table(name);
    return read_format(table, per_unit);
  };
  profile.position_format = format("position", "counts_per_mm");
  profile.speed_format = format("speed", "counts_per_mm_per_s");
  profile.acceleration_format = format("acceleration", "counts_per_mm_per_s2");
  profile.deceleration_format = format("deceleration", "counts_per_mm_per_s2");
  TomlReader commands = top.table("commands");
  for (std::size_t i = 0; i < kCommands; ++i) {
    const std::string_view name = kCommandNames.at(i);
    auto& writes = profile.commands.at(i);
    for (TomlReader& table : commands.tables(name)) writes.push_back(read_write(table, profile));
    const bool may_lack = i <= static_cast<std::size_t>(Command::kDisable);
    if (writes.empty() && !may_lack) commands.refuse(name, "is empty. Add the registers to write");
  }
}

void read_watchdog(TomlReader& top, DriveProfile& profile) {
  if (!top.has("watchdog")) return;
  TomlReader table = top.table("watchdog");
  Watchdog watchdog;
  watchdog.time = read_field(table.table("time"), "counts_per_s");
  watchdog.largest_time_s = table.number("largest_time_s", 0.01, 5);
  if (table.has("action")) {
    TomlReader action = table.table("action");
    watchdog.action = Field{read_space(action), read_word(action, "address"), {}};
    for (const toml::node* node : table.array("stopping_actions")) {
      const auto value = read_value(*node);
      if (!value || value->quantity != Quantity::kWord) {
        table.refuse("stopping_actions",
                     "contains an invalid register value. Use words from 0 to 65535");
        break;
      }
      watchdog.stopping.push_back(value->word);
    }
  } else if (!table.flag("always_stops")) {
    table.refuse(
        "always_stops",
        "is false, but there is no action. Set it to true, or add action and stopping_actions");
  }
  profile.watchdog = std::move(watchdog);
}

void read_motion(TomlReader table, DriveProfile& profile) {
  profile.max_speed_mm_per_s = table.number("max_speed_mm_per_s", 0.01, 1000);
  profile.acceleration_mm_per_s2 = table.number("acceleration_mm_per_s2", 0.1, 1e5);
  profile.stopping_deceleration_mm_per_s2 =
      table.number("stopping_deceleration_mm_per_s2", 0.1, 1e5);
  if (table.has("homing_speed_mm_per_s")) {
    profile.homing_speed_mm_per_s = table.number("homing_speed_mm_per_s", 0.01, 1000);
    if (*profile.homing_speed_mm_per_s > profile.max_speed_mm_per_s) {
      table.refuse("homing_speed_mm_per_s",
                   "is higher than max_speed_mm_per_s. Set a lower homing speed in the drive and "
                   "here");
    }
  }
  profile.jog_refresh_s = table.number("jog_refresh_s", 0.01, 0.25);
  profile.jog_dead_man_s = table.number("jog_dead_man_s", 0, 0.5);
  if (profile.jog_dead_man_s > 0 && profile.jog_dead_man_s < profile.jog_refresh_s) {
    table.refuse("jog_dead_man_s",
                 "is shorter than jog_refresh_s. Set jog_refresh_s to jog_dead_man_s or less");
  }
}

std::chrono::milliseconds read_duration(TomlReader& table, std::string_view key) {
  return std::chrono::milliseconds(std::lround(1000 * table.number(key, 0.005, 5)));
}

void read_timing(TomlReader& table, DriveProfile& profile) {
  profile.response_timeout = read_duration(table, "response_timeout_s");
  profile.worst_delay = read_duration(table, "worst_delay_s");
  profile.bus.silence_after_bad_reply = table.flag("silence_after_bad_reply", false);
}

}  // namespace

Result<DriveProfile> read_drive_profile(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(TomlReader top, TomlReader::open(path));
  DriveProfile profile;
  profile.name = top.text("name");
  profile.tried_on_hardware = top.flag("tried_on_hardware");
  profile.is_virtual = top.flag("virtual", false);
  profile.unit = static_cast<int>(top.integer("unit", 1, 247, 1));
  profile.single_writes_by_fc16 = top.flag("single_writes_by_fc16", false);
  profile.bus.echo = top.flag("echo", false);
  profile.bus.unit_any = top.flag("unit_any", false);
  profile.bus.rtu_over_tcp = top.flag("rtu_over_tcp", false);
  read_motion(top.table("motion"), profile);
  TomlReader timing = top.table("timing");
  read_timing(timing, profile);
  for (TomlReader& table : top.tables("identity")) {
    const Space space = read_space(table);
    profile.identity.push_back(read_mark(table, space));
  }
  if (profile.identity.empty())
    top.refuse("identity", "is empty. Add registers that identify this drive");
  profile.blocks = read_blocks(top);
  profile.position = read_polled(top, profile.blocks, "position", "counts_per_mm");
  if (top.has("velocity")) {
    profile.velocity = read_polled(top, profile.blocks, "velocity", "counts_per_mm_per_s");
  }
  if (top.has("demand")) {
    profile.demand = read_polled(top, profile.blocks, "demand", "counts_per_mm");
  }
  read_alarms(top, profile);
  read_bits(top, profile);
  read_commands(top, profile);
  read_watchdog(top, profile);
  check_parts(top, profile);
  check_budget(timing, profile);
  HP_RETURN_IF_ERROR(top.finish());
  return profile;
}

double stopping_distance_mm(const DriveProfile& profile, double speed_mm_per_s, double watchdog_s) {
  const double speed = std::abs(speed_mm_per_s);
  return speed * watchdog_s + speed * speed / (2 * profile.stopping_deceleration_mm_per_s2);
}

}  // namespace hydroprint::drive
