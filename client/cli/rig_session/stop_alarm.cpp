#include "client/cli/rig_session/stop_alarm.h"

#include <unistd.h>

#include <iostream>
#include <utility>

#include "client/cli/terminal/console.h"
#include "client/rig.h"

namespace hydroprint::cli {
namespace {

constexpr char kCause[] = "STOP_NOT_OBEYED";
constexpr char kWords[] =
    "PRESS THE STOP BUTTON ON THE RIG: the drive acknowledged a stop, but does not slow down";
constexpr char kBell[] = "\a";
constexpr char kClearLine[] = "\r\x1b[K";  // there may be a live line

}  // namespace

Status stop_obeyed(const v1::Rig& rig) {
  if (rig.cause() != kCause) return {};
  return tl::unexpected(Error{Code::kInternal,
                              rig.trouble().empty() ? kWords : printable(rig.trouble()),
                              ErrorReason::RIG_FAULTED,
                              {{"cause", kCause}}});
}

void StopAlarm::look(const v1::Rig& rig) {
  const bool is_on = rig.cause() == kCause;
  if (std::exchange(is_on_, is_on) || !is_on) return;
  if (isatty(STDERR_FILENO) == 1) std::cerr << kClearLine << kBell;
  std::cerr << "hydroprint: " << kWords << std::endl;
}

void StopAlarm::look(const Program& program) {
  client::Connection daemon = program.uninterrupted();
  if (const auto rig = client::get_rig(daemon)) look(*rig);
}

}  // namespace hydroprint::cli
