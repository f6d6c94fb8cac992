#include "daemon/rig_guard.h"

#include <chrono>
#include <utility>

#include "daemon/log.h"
#include "daemon/rig_convert.h"

namespace hydroprint::daemon {
namespace {

constexpr std::chrono::milliseconds kLook{100};

bool wants_help(v1::Rig::State state) {
  return state == v1::Rig::OFFLINE || state == v1::Rig::FAULT || state == v1::Rig::ESTOPPED;
}

}  // namespace

RigGuard::RigGuard(RigDesk& desk, PlaceKeeper& places, std::function<void(bool)> tell)
    : desk_(desk), places_(places), tell_(std::move(tell)), thread_([this] { run(); }) {}

RigGuard::~RigGuard() {
  end_ = true;
  thread_.join();
}

void RigGuard::run() {
  for (; !end_; std::this_thread::sleep_for(kLook)) look();
}

void RigGuard::look() {
  if (const auto expired = desk_.leases().take_expired()) {
    desk_.end_jog();
    log(LogLevel::kInfo, "lease_expired", {{"holder", expired->holder}});
  }
  for (const std::string& who : desk_.take_stops()) {
    log(LogLevel::kInfo, "rig_stop_asked", {{"by", who}});
  }
  places_.look();
  const v1::Rig rig = rig_message(desk_);
  const bool serving = !wants_help(rig.state());
  if (told_ != serving) tell_(serving);
  told_ = serving;
  const std::string state = v1::Rig::State_Name(rig.state()) + (serving ? "" : " " + rig.cause());
  if (std::exchange(state_, state) == state || desk_.controller() == nullptr) return;
  log(serving ? LogLevel::kInfo : LogLevel::kWarning, "rig_state",
      {{"state", v1::Rig::State_Name(rig.state())},
       {"cause", rig.cause()},
       {"message", rig.trouble()}});
}

}  // namespace hydroprint::daemon
