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

/// The two kinds of 16-bit registers.
enum class Space { kHolding, kInput };

/// Encoding of a number in registers: raw = value * per_unit, or per_unit / value if `inverse` (for
/// a ramp given as a time), rounded to an integer.
struct Format {
  int words = 1;                ///< 1 or 2 registers of 16 bits
  bool is_signed = false;       ///< two's complement
  bool low_word_first = false;  ///< word order if there are two; default: high word first
  double per_unit = 1;          ///< counts per mm, mm/s, mm/s^2 or s; negative reverses the axis
  bool inverse = false;
};

/// A number in the drive's memory.
struct Field {
  Space space = Space::kHolding;
  std::uint16_t address = 0;
  Format format;
};

/// A register and its required content: `(word & mask) == value`.
struct Mark {
  Space space = Space::kHolding;
  std::uint16_t address = 0;
  std::uint16_t value = 0;
  std::uint16_t mask = 0xffff;
  std::string meaning;  ///< "model", for error messages
};

/// Registers that are read with one request. The mark lies within the block and distinguishes the
/// reply from a late reply to another request. Blocks of a profile differ in length, also from
/// their parts (block_parts.h).
struct Block {
  Space space = Space::kHolding;
  std::uint16_t address = 0;
  std::uint16_t count = 0;
  Mark mark;
};

/// A drive's status, as single bits.
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

/// Location of a status bit.
struct BitPlace {
  Space space = Space::kHolding;
  std::uint16_t address = 0;
  int bit = 0;
  bool inverted = false;
};

/// The commands of a drive.
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

/// A component of a write: a word, or a quantity with as many words as its format has.
enum class Quantity { kWord, kPosition, kSpeed, kNegativeSpeed, kAcceleration, kDeceleration };
struct Value {
  Quantity quantity = Quantity::kWord;
  std::uint16_t word = 0;
};

/// A request that writes consecutive holding registers.
struct Write {
  std::uint16_t address = 0;
  std::vector<Value> values;
};

/// The meaning and remedy of an alarm code.
struct Alarm {
  std::string text;
  std::string hint;
};

/// The drive's watchdog, which monitors the communication.
struct Watchdog {
  Field time;                                ///< the watchdog time in s
  double largest_time_s = 0;                 ///< longest permitted time; 0 is never permitted
  std::optional<Field> action;               ///< reaction to a timeout; absent: always a stop
  std::vector<std::uint16_t> stopping = {};  ///< values of `action` that stop the axis
};

/// How a bus differs from plain Modbus.
struct BusVariant {
  bool echo = false;          ///< the adapter sends each request back, before the drive's reply
  bool unit_any = false;      ///< replies come from any unit, as those of some gateways do
  bool rtu_over_tcp = false;  ///< the gateway expects RTU frames over TCP
  /// The drive must not receive a request while the reply to an earlier one may still arrive.
  bool silence_after_bad_reply = false;
};

/// The description of a type of drive, read from a TOML file; hardware/profiles explains each key.
/// Positions are relative to the home switch. The sign of `position.per_unit` determines which
/// direction is positive (down, in a rig for dipping).
struct DriveProfile {
  std::string name;
  bool tried_on_hardware = false;
  bool is_virtual = false;             ///< simulated by hydroprint-virtual-rig: nobody can be hurt
  int unit = 1;                        ///< Modbus unit (slave) id, 1 to 247
  bool single_writes_by_fc16 = false;  ///< single words are written with function 16, not 6

  double max_speed_mm_per_s = 0;
  double acceleration_mm_per_s2 = 0;  ///< acceleration of moves, jogs and homing
  /// Highest speed of homing, which is a setting of the drive; absent: unknown.
  std::optional<double> homing_speed_mm_per_s;
  /// Lowest deceleration of a stop command and of the watchdog.
  double stopping_deceleration_mm_per_s2 = 0;

  std::chrono::milliseconds response_timeout{0};  ///< timeout of one request
  std::chrono::milliseconds worst_delay{0};       ///< after this time a reply can no longer arrive
  BusVariant bus;

  std::vector<Mark> identity;
  std::vector<Block> blocks;  ///< registers to poll; contain all fields and bits below

  Field position, alarm_code;
  /// Absent: Drive::poll derives the velocity from positions, so the two cannot be compared.
  std::optional<Field> velocity;
  std::optional<Field> demand;  ///< position of the drive's own trajectory
  std::array<std::optional<BitPlace>, kStatusBits> bits;
  std::map<int, Alarm> alarms;

  /// Encodings of the quantities in writes.
  Format position_format, speed_format, acceleration_format, deceleration_format;
  std::array<std::vector<Write>, kCommands> commands;  ///< writes of each command, in sending order
  double jog_refresh_s = 0;  ///< maximum interval between the commands of a jog
  /// Time after its last command at which a jog ends; 0: only the watchdog ends it.
  double jog_dead_man_s = 0;

  std::optional<Watchdog> watchdog;  ///< absent: the drive has none and must not be armed

  [[nodiscard]] const std::optional<BitPlace>& bit(StatusBit which) const {
    return bits[static_cast<std::size_t>(which)];
  }
  [[nodiscard]] const std::vector<Write>& command(Command which) const {
    return commands[static_cast<std::size_t>(which)];
  }
};

/// Reads and validates a profile. Errors name file, line and remedy. They cover unknown and missing
/// keys, wrong types, values out of range, fields outside all blocks, blocks of equal length or
/// without a mark, addresses beyond 65535, a homing speed above the highest speed, and profiles
/// with which one lost reply would end a motion (link_budget.h).
[[nodiscard]] Result<DriveProfile> read_drive_profile(const std::filesystem::path& path);

/// Returns an upper bound of the distance that the axis travels after the last message to the
/// drive, if the link breaks at `speed_mm_per_s`: v t_watchdog + v^2 / 2a.
[[nodiscard]] double stopping_distance_mm(const DriveProfile& profile, double speed_mm_per_s,
                                          double watchdog_s);

}  // namespace hydroprint::drive
