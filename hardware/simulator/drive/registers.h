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

/// The memory of a drive with a given profile: which registers may be read and written, and which
/// writes are commands.
class Registers {
 public:
  /// Initialises the registers with the profile's identity and the given watchdog settings.
  /// `watchdog_action` is the content of the register that selects the watchdog's action; it is
  /// ignored if the profile has no such register.
  Registers(drive::DriveProfile profile, double watchdog_s, std::uint16_t watchdog_action);

  /// Stores the drive's state in the registers; ignores its times and texts.
  void set_state(const drive::DriveState& state);

  /// Returns `count` words; nullopt if one of them does not exist (Modbus exception 2).
  [[nodiscard]] std::optional<std::vector<std::uint16_t>> read(drive::Space space,
                                                               std::uint16_t address,
                                                               std::size_t count) const;

  /// Stores words in holding registers; false if one of them does not exist.
  [[nodiscard]] bool write(std::uint16_t address, std::span<const std::uint16_t> words);

  /// Returns the command that is completed by writing these words, with its quantities; nullopt if
  /// they do not complete a command. Must be called after write().
  [[nodiscard]] std::optional<Order> order(std::uint16_t address,
                                           std::span<const std::uint16_t> words) const;

  /// Return the watchdog settings now in the registers, which a client may have changed.
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
