#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hardware/drive/drive.h"
#include "hardware/drive/profile.h"
#include "hardware/simulator/drive/drive_model.h"

namespace hydroprint::simulated_drive {

/// The memory of a drive of a given profile: what a request may read and write, and what commands
/// are written.
class Registers {
 public:
  /// Holds the profile's identity, and the watchdog as set. `watchdog_action` is the register's
  /// value, ignored if the profile has no such register.
  Registers(drive::DriveProfile profile, double watchdog_s, std::uint16_t watchdog_action);

  /// Writes what the drive tells of itself; the bits of `state` count, not its texts.
  void tell(const drive::DriveState& state);

  /// `count` words; none if one of them does not exist (Modbus exception 2).
  [[nodiscard]] std::optional<std::vector<std::uint16_t>> read(drive::Space space,
                                                               std::uint16_t address,
                                                               std::size_t count) const;

  /// Keeps words in holding registers; false if one of them does not exist.
  [[nodiscard]] bool write(std::uint16_t address, std::span<const std::uint16_t> words);

  /// The command whose last write these words are, with its quantities; none if they are no more
  /// than words. To be asked after write().
  [[nodiscard]] std::optional<Order> order(std::uint16_t address,
                                           std::span<const std::uint16_t> words) const;

  /// As the registers say now.
  [[nodiscard]] double watchdog_s() const;
  [[nodiscard]] WatchdogAction watchdog_action() const;

  [[nodiscard]] const drive::DriveProfile& profile() const { return profile_; }

 private:
  using Place = std::pair<drive::Space, std::uint16_t>;
  void make(drive::Space space, std::uint16_t address, int words);
  void put(const drive::Field& field, double value);
  void put_bit(drive::StatusBit which, bool value);
  [[nodiscard]] bool is_written(const drive::Write& write, std::uint16_t address,
                                std::span<const std::uint16_t> words) const;
  void take(const drive::Write& write, Order& order) const;

  drive::DriveProfile profile_;
  std::map<Place, std::uint16_t> memory_;
};

}  // namespace hydroprint::simulated_drive
