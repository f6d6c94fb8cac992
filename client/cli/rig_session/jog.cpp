#include "client/cli/rig_session/jog.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <thread>

#include "client/cli/format/json.h"
#include "client/cli/format/rig_display.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/cli/rig_session/jogger.h"
#include "client/cli/rig_session/motion.h"
#include "client/cli/rig_session/stop_alarm.h"
#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr double kSpeedByKeys_mm_per_s = 2;

// Sleeps until `time`, or until Ctrl-C.
void sleep_until(Program& program, Clock::time_point time) {
  while (!program.is_interrupted() && Clock::now() < time) std::this_thread::sleep_for(5ms);
}

// Sends a jog command every 100 ms, until the time is over.
Status jog_for(Program& program, StopAlarm& alarm, const std::string& lease_id,
               double speed_mm_per_s, double time_s) {
  RigDisplay display(STDERR_FILENO);
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(time_s));
  for (auto next = Clock::now(); next < end && !program.is_interrupted();) {
    HP_ASSIGN_OR_RETURN(const auto rig,
                        client::jog_rig(program.daemon(), lease_id, speed_mm_per_s));
    alarm.look(rig);
    display.update(rig);
    next = std::min(next + Jogger::kPeriod, end);
    sleep_until(program, next);
  }
  return {};
}

// Jogs while keys are held, until q or Ctrl-C.
Status jog_by_keys(Program& program, StopAlarm& alarm, const std::string& lease_id,
                   double speed_mm_per_s) {
  std::cerr << "hold Down or j: down; hold Up or k: up; + and -: faster, slower; q: quit; other "
               "keys, or none: stop"
            << std::endl;
  LiveLine line(STDERR_FILENO);
  Keyboard keyboard;
  Jogger jogger(program.daemon(), lease_id, speed_mm_per_s);
  auto looked = Clock::now() - 1s;
  v1::Rig rig;
  while (!program.is_interrupted() && !keyboard.gone()) {
    for (const Key key : keyboard.read(20ms)) {
      if (key == Key::kQuit) return {};
      jogger.press(key, Clock::now());
    }
    HP_ASSIGN_OR_RETURN(const auto answer, jogger.tick(Clock::now()));
    if (answer) rig = *answer;
    if (!answer && Clock::now() - looked > Jogger::kPeriod) {
      HP_ASSIGN_OR_RETURN(rig, client::get_rig(program.daemon()));
      looked = Clock::now();
    }
    alarm.look(rig);
    line.show(rig_line(rig) + "   " + jogger.text());
  }
  return {};
}

Status jog_as_told(Program& program, StopAlarm& alarm, const JogOptions& options) {
  if (!options.time_s && !Keyboard::is_there())
    return fail(Code::kInvalidArgument,
                "jogging with keys needs a terminal; use --speed MM/S and --for TIME");
  if (options.time_s && !options.speed_mm_per_s)
    return fail(Code::kInvalidArgument, "--for requires --speed MM/S, positive for down");
  HP_ASSIGN_OR_RETURN(const auto lease, HeldLease::take(program, options.with_lease));
  if (options.time_s)
    return jog_for(program, alarm, lease->id(), *options.speed_mm_per_s, *options.time_s);
  return jog_by_keys(program, alarm, lease->id(),
                     std::abs(options.speed_mm_per_s.value_or(kSpeedByKeys_mm_per_s)));
}

}  // namespace

Status jog(Program& program, const JogOptions& options) {
  StopAlarm alarm;
  const Status jogged = jog_as_told(program, alarm, options);
  const bool cancelled = program.is_interrupted();
  // A jog that was refused needs no stop. When jogging with keys, the stop was sent when the key
  // was released. A motion in progress may be this jog, which somebody else has stopped.
  const bool lost = !jogged && jogged.error().code == Code::kUnavailable;
  const bool refused = !jogged && !cancelled && !lost;
  if (refused && jogged.error().reason != ErrorReason::MOTION_IN_PROGRESS) return jogged;
  const bool is_stopped = refused || !options.time_s;
  const auto rig = is_stopped ? wait_for_rest(program, alarm) : stop_and_wait(program, alarm);
  if (rig) HP_RETURN_IF_ERROR(stop_obeyed(*rig));
  if (!jogged && !cancelled) return jogged;
  if (!rig) return tl::unexpected(rig.error());
  if (cancelled) return fail(Code::kCancelled, "interrupted: the axis was stopped");
  if (program.json())
    print(*rig);
  else
    std::cout << rig_line(*rig) << std::endl;
  return {};
}

}  // namespace hydroprint::cli
