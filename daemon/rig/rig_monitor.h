#pragma once

#include <functional>
#include <optional>
#include <string>

#include "daemon/rig/rig_gateway.h"
#include "daemon/rig/rig_reference.h"
#include "hydroprint/v1/rig.pb.h"
#include "sim/base/process/periodic_thread.h"

namespace hydroprint::daemon {

/// Monitors the rig ten times a second. Ends a jog whose lease has expired, and reports when the
/// rig becomes usable or unusable or does not obey a stop, and once how the system schedules the
/// control loop. Writes log
/// entries for threads that must not wait for the log, and makes RigReference check for homing.
class RigMonitor {
 public:
  /// @param set_serving  called at the start and after every change; true means that the rig is
  ///                     usable: not OFFLINE, FAULT or ESTOPPED
  RigMonitor(RigGateway& gateway, RigReference& places, std::function<void(bool)> set_serving);

 private:
  void look();
  void log_scheduling(const v1::LinkQuality& link);
  void log_stop(const v1::Rig& rig);

  RigGateway& gateway_;
  RigReference& places_;
  std::function<void(bool)> set_serving_;
  std::optional<bool> was_serving_;
  std::string state_;  // last logged state
  bool is_scheduling_logged_ = false;
  bool is_stop_ignored_ = false;
  PeriodicThread thread_;
};

}  // namespace hydroprint::daemon
