#pragma once

#include <functional>
#include <optional>
#include <string>

#include "daemon/rig/rig_gateway.h"
#include "daemon/rig/rig_reference.h"
#include "sim/base/process/periodic_thread.h"

namespace hydroprint::daemon {

/// Looks after the rig when nobody calls, ten times a second: ends a jog whose lease ran out, tells
/// when the rig begins or ceases to work, and logs what those who must not wait for the log left to
/// it. Has it noticed when the rig was homed.
class RigMonitor {
 public:
  /// @param tell  true: the rig works, as far as is known (not OFFLINE, FAULT or ESTOPPED); called
  /// at the start and with every change
  RigMonitor(RigGateway& gateway, RigReference& places, std::function<void(bool)> tell);

 private:
  void look();

  RigGateway& gateway_;
  RigReference& places_;
  std::function<void(bool)> tell_;
  std::optional<bool> told_;
  std::string state_;  // as logged last
  PeriodicThread thread_;
};

}  // namespace hydroprint::daemon
