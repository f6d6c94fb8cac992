#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "daemon/rig_desk.h"
#include "daemon/rig_place.h"

namespace hydroprint::daemon {

/// Looks after the rig when nobody calls, ten times a second: ends a jog whose lease ran out, tells
/// when the rig begins or ceases to work, and logs what those who must not wait for the log left to
/// it. Has it noticed when the rig was homed.
class RigGuard {
 public:
  /// @param tell  true: the rig works, as far as is known (not OFFLINE, FAULT or ESTOPPED); called
  /// at the start and with every change
  RigGuard(RigDesk& desk, PlaceKeeper& places, std::function<void(bool)> tell);
  ~RigGuard();
  RigGuard(const RigGuard&) = delete;
  RigGuard& operator=(const RigGuard&) = delete;

 private:
  void run();
  void look();

  RigDesk& desk_;
  PlaceKeeper& places_;
  std::function<void(bool)> tell_;
  std::optional<bool> told_;
  std::string state_;  // as logged last
  std::atomic<bool> end_{false};
  std::thread thread_;
};

}  // namespace hydroprint::daemon
