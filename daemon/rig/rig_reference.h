#pragma once

#include <cstdint>
#include <mutex>

#include "daemon/store/database/database.h"
#include "daemon/store/rig_place.h"
#include "hardware/rig/controller.h"

namespace hydroprint::daemon {

/// Watches what makes it uncertain where the object hangs. Any thread may call; nothing waits for
/// the drive, and but for keep() and note_dip() nothing for the disk.
class RigReference {
 public:
  /// @param controller  null if there is no rig
  RigReference(Database& database, const rig::Controller* controller)
      : database_(database), controller_(controller) {}

  /// Reads the counts of earlier days; before anything else.
  [[nodiscard]] Status load();
  /// Looks whether the rig was homed since the last look; to be called often. (A homing that is
  /// forgotten with the daemon does no harm: after its start the rig wants homing again.)
  void look() { (void)place(); }
  /// As it is now.
  [[nodiscard]] RigPlace place();
  /// Has the counts outlive the daemon: before anything is stored that is to be compared with them.
  [[nodiscard]] Status keep();
  /// Something goes into the water.
  void note_dip();

 private:
  Database& database_;
  const rig::Controller* controller_;
  std::mutex mutex_;
  bool homed_ = false;
  std::int64_t homings_ = 0, dips_ = 0;
};

}  // namespace hydroprint::daemon
