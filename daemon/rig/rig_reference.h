#pragma once

#include <cstdint>
#include <mutex>

#include "daemon/store/database/database.h"
#include "daemon/store/rig_place.h"
#include "hardware/rig/controller.h"

namespace hydroprint::daemon {

/// Tracks events that make the object's position uncertain. Thread-safe. Never waits for the drive;
/// only keep() and note_dip() wait for the disk.
class RigReference {
 public:
  /// @param controller  null if there is no rig
  RigReference(Database& database, const rig::Controller* controller)
      : database_(database), controller_(controller) {}

  /// Reads the stored counts. Must be called first.
  [[nodiscard]] Status load();
  /// Counts a homing if the rig was homed since the last call. Must be called often enough to
  /// notice each homing. A homing that is not stored before the daemon exits does no harm: after
  /// the start, homing is required again.
  void look() { (void)place(); }
  /// Returns the current state of the rig.
  [[nodiscard]] RigPlace place();
  /// Stores the counts. Must be called before data is stored that is later compared with them.
  [[nodiscard]] Status keep();
  /// Counts a dip.
  void note_dip();

 private:
  Database& database_;
  const rig::Controller* controller_;
  std::mutex mutex_;
  bool homed_ = false;
  std::int64_t homings_ = 0, dips_ = 0;
};

}  // namespace hydroprint::daemon
