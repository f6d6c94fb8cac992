#include "daemon/rig/rig_monitor.h"

#include <chrono>
#include <utility>

#include "daemon/platform/log.h"
#include "daemon/rig/to_proto_rig.h"
#include "hardware/rig/state_names.h"

namespace hydroprint::daemon {
namespace {

constexpr std::chrono::milliseconds kLook{100};

bool wants_help(v1::Rig::State state) {
  return state == v1::Rig::OFFLINE || state == v1::Rig::FAULT || state == v1::Rig::ESTOPPED;
}

}  // namespace

RigMonitor::RigMonitor(RigGateway& gateway, RigReference& places,
                       std::function<void(bool)> set_serving)
    : gateway_(gateway),
      places_(places),
      set_serving_(std::move(set_serving)),
      thread_(kLook, [this] { look(); }) {}

void RigMonitor::look() {
  if (const auto expired = gateway_.leases().take_expired()) {
    gateway_.end_jog();
    log(LogLevel::kInfo, "lease_expired", {{"holder", expired->holder}});
  }
  for (const std::string& who : gateway_.take_stops()) {
    log(LogLevel::kInfo, "rig_stop_asked", {{"by", who}});
  }
  places_.look();
  const v1::Rig rig = rig_message(gateway_);
  const bool serving = !wants_help(rig.state());
  if (was_serving_ != serving) set_serving_(serving);
  was_serving_ = serving;
  log_scheduling(rig.link_quality());
  log_stop(rig);
  const std::string state = v1::Rig::State_Name(rig.state()) + (serving ? "" : " " + rig.cause());
  if (std::exchange(state_, state) == state || gateway_.controller() == nullptr) return;
  log(serving ? LogLevel::kInfo : LogLevel::kWarning, "rig_state",
      {{"state", v1::Rig::State_Name(rig.state())},
       {"cause", rig.cause()},
       {"message", rig.trouble()}});
}

// Written once for each time that the drive does not obey a stop.
void RigMonitor::log_stop(const v1::Rig& rig) {
  const bool is_ignored = rig.cause() == rig::name(rig::Cause::kStopNotObeyed);
  if (std::exchange(is_stop_ignored_, is_ignored) || !is_ignored) return;
  log(LogLevel::kCritical, "rig_stop_not_obeyed", {{"message", rig.trouble()}});
}

// A warning if the system refused something, because the rig may then stop with LINK_LOST while the
// machine is busy.
void RigMonitor::log_scheduling(const v1::LinkQuality& link) {
  if (is_scheduling_logged_ || link.scheduling() == v1::LinkQuality::SCHEDULING_UNSPECIFIED) return;
  is_scheduling_logged_ = true;
  const bool is_full = link.scheduling() == v1::LinkQuality::REAL_TIME && link.memory_locked();
  log(is_full ? LogLevel::kInfo : LogLevel::kWarning, "rig_thread",
      {{"scheduling", v1::LinkQuality::Scheduling_Name(link.scheduling())},
       {"memory_locked", link.memory_locked() ? "yes" : "no"}});
}

}  // namespace hydroprint::daemon
