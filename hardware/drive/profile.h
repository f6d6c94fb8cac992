#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::drive {

/// Which of the two kinds of 16-bit register.
enum class Space { kHolding, kInput };

/// How a number stands in registers: raw = value * per_unit, or per_unit / value if `inverse` (a
/// ramp given as a time), rounded to an integer.
struct Format {
  int words = 1;                ///< 1 or 2 registers of 16 bits
  bool is_signed = false;       ///< two's complement
  bool low_word_first = false;  ///< of two words; high first otherwise
  double per_unit = 1;          ///< counts per mm, mm/s, mm/s^2 or s; negative turns the axis round
  bool inverse = false;
};

/// A number in the drive's memory.
struct Field {
  Space space = Space::kHolding;
  std::uint16_t address = 0;
  Format format;
};

/// A register and what it must hold: `(word & mask) == value`.
struct Mark {
  Space space = Space::kHolding;
  std::uint16_t address = 0;
  std::uint16_t value = 0;
  std::uint16_t mask = 0xffff;
  std::string meaning;  ///< "model", for messages
};

/// Registers read in one request. The mark lies within and tells a reply that is late, and meant
/// for another request, from the right one; no two requests of a profile read the same number of
/// words.
struct Block {
  Space space = Space::kHolding;
  std::uint16_t address = 0;
  std::uint16_t count = 0;
  Mark mark;
};

/// What a drive tells about itself in single bits.
enum class StatusBit {
  kEnabled,
  kHomed,
  kMoving,
  kAlarm,
  kPositiveEnd,
  kNegativeEnd,
  kHomeSwitch,
  kStopInput,
};
inline constexpr std::size_t kStatusBits = 8;

/// Name in the profile file: "enabled", "positive_end".
[[nodiscard]] std::string_view status_bit_name(StatusBit bit);

/// Where a status bit stands.
struct BitPlace {
  Space space = Space::kHolding;
  std::uint16_t address = 0;
  int bit = 0;
  bool inverted = false;
};

/// What a drive can be told.
enum class Command {
  kEnable,
  kDisable,
  kHome,
  kMove,
  kJogPositive,
  kJogNegative,
  kStop,
  kResetFault,
};
inline constexpr std::size_t kCommands = 8;

/// Name in the profile file: "enable", "jog_positive".
[[nodiscard]] std::string_view command_name(Command command);

/// What stands at a place of a write: a word, or a quantity that takes as many words as its format.
enum class Quantity { kWord, kPosition, kSpeed, kNegativeSpeed, kAcceleration, kDeceleration };
struct Value {
  Quantity quantity = Quantity::kWord;
  std::uint16_t word = 0;
};

/// One request that writes consecutive holding registers.
struct Write {
  std::uint16_t address = 0;
  std::vector<Value> values;
};

/// What an alarm code means and what to do about it.
struct Alarm {
  std::string text;
  std::string hint;
};

/// How the drive watches that it is being talked to.
struct Watchdog {
  Field time;                                ///< in s
  double largest_time_s = 0;                 ///< a longer time is not accepted; 0 never is
  std::optional<Field> action;               ///< absent: this drive always stops
  std::vector<std::uint16_t> stopping = {};  ///< values of `action` that stop the axis
};

/// All that is known of a make of drive; a TOML file, hardware/profiles says more of each key.
/// Positions count from the home switch; the sign of `position.per_unit` decides which way is
/// positive (down, in a rig for dipping).
struct DriveProfile {
  std::string name;
  bool tried_on_hardware = false;
  bool is_virtual = false;             ///< hydroprint-virtual-rig plays it: nobody can be hurt
  int unit = 1;                        ///< Modbus unit (slave) id, 1 to 247
  bool single_writes_by_fc16 = false;  ///< one word is written by function 16 as well, not by 6

  double max_speed_mm_per_s = 0;
  double acceleration_mm_per_s2 = 0;           ///< of moves, jogs and homing
  double stopping_deceleration_mm_per_s2 = 0;  ///< the least with which stop and watchdog brake

  std::chrono::milliseconds response_timeout{0};  ///< of one request
  std::chrono::milliseconds worst_delay{0};       ///< after which the drive surely answers no more

  std::vector<Mark> identity;
  std::vector<Block> blocks;  ///< what is polled; all fields and bits below lie within

  Field position, velocity, alarm_code;
  std::optional<Field> demand;  ///< where the drive's own trajectory is
  std::array<std::optional<BitPlace>, kStatusBits> bits;
  std::map<int, Alarm> alarms;

  Format position_format, speed_format, acceleration_format, deceleration_format;  ///< in writes
  std::array<std::vector<Write>, kCommands> commands;  ///< in the order in which they are sent
  double jog_refresh_s = 0;   ///< a jog is to be commanded again at least this often
  double jog_dead_man_s = 0;  ///< a jog not commanded again for so long ends; 0: watchdog only

  std::optional<Watchdog> watchdog;  ///< absent: the drive has none, and is never safe to arm

  [[nodiscard]] const std::optional<BitPlace>& bit(StatusBit which) const {
    return bits[static_cast<std::size_t>(which)];
  }
  [[nodiscard]] const std::vector<Write>& command(Command which) const {
    return commands[static_cast<std::size_t>(which)];
  }
};

/// Reads and checks a profile. Refuses, naming file, line and remedy: unknown and missing keys,
/// wrong types, values out of range, fields outside all blocks, blocks of equal length or without
/// mark, addresses beyond 65535.
[[nodiscard]] Result<DriveProfile> read_drive_profile(const std::filesystem::path& path);

/// The axis stands within this distance after the last thing that the drive was told, if the link
/// breaks at `speed_mm_per_s` (daemon notes 3.6): v t_watchdog + v^2 / 2a.
[[nodiscard]] double stopping_distance_mm(const DriveProfile& profile, double speed_mm_per_s,
                                          double watchdog_s);

}  // namespace hydroprint::drive
