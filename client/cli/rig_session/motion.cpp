#include "client/cli/rig_session/motion.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>

#include "client/cli/format/rig_display.h"
#include "client/cli/terminal/console.h"
#include "client/rig.h"

namespace hydroprint::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kRate_hz = 10;
constexpr std::chrono::seconds kRestWithin{2};

bool moves(const v1::Rig& rig) {
  return rig.state() == v1::Rig::MOVING || rig.state() == v1::Rig::DIPPING ||
         rig.state() == v1::Rig::STOPPING;
}

std::string position(const v1::Rig& rig) {
  return rig.has_position_mm() ? fmt::format("at {:.2f} mm", rig.position_mm())
                               : "at an unknown position";
}

// Returns whether this motion has ended and the axis is at standstill, another motion has replaced
// this one, or a stop is not obeyed.
bool is_over(const v1::Rig& rig, std::uint64_t number) {
  if (!stop_obeyed(rig)) return true;
  if (!rig.has_motion() || rig.motion().number() != number) return true;
  if (rig.motion().outcome() == v1::Motion::RUNNING) return false;
  return rig.motion().at_rest() || !moves(rig);
}

// Returns an error if the motion did not reach its target.
Status judge(const v1::Rig& rig, std::uint64_t number) {
  HP_RETURN_IF_ERROR(stop_obeyed(rig));
  if (!rig.has_motion() || rig.motion().number() != number)
    return fail(Code::kAborted,
                "another motion has replaced this one; see 'hydroprint rig status'");
  const v1::Motion& motion = rig.motion();
  if (motion.outcome() == v1::Motion::DONE) return {};
  if (motion.outcome() == v1::Motion::STOPPED)
    return fail(Code::kAborted, "the axis was stopped " + position(rig));
  return tl::unexpected(Error{Code::kInternal,
                              fmt::format("the motion failed {}: {}", position(rig),
                                          rig.trouble().empty() ? motion.cause() : rig.trouble()),
                              ErrorReason::RIG_FAULTED,
                              {{"cause", motion.cause()}}});
}

Error stopped_on_request(const Program& program, StopAlarm& alarm) {
  const auto rig = stop_and_wait(program, alarm);
  if (!rig)
    return {rig.error().code, "the stop command failed: " + rig.error().message,
            rig.error().reason};
  if (Status obeyed = stop_obeyed(*rig); !obeyed) return std::move(obeyed).error();
  if (moves(*rig))
    return {Code::kCancelled,
            "interrupted: the stop was sent, but the axis still moves; use the stop button",
            {}};
  return {Code::kCancelled, "interrupted: the axis was stopped " + position(*rig), {}};
}

Error lost(Error error) {
  error.message +=
      "; the axis may still be moving. See 'hydroprint rig status', or use the stop button";
  return error;
}

}  // namespace

Result<v1::Rig> wait_for_rest(const Program& program, StopAlarm& alarm) {
  client::Connection daemon = program.uninterrupted();
  auto rig = client::get_rig(daemon);
  const auto begin = Clock::now();
  while (rig && moves(*rig) && stop_obeyed(*rig) && Clock::now() - begin < kRestWithin) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    rig = client::get_rig(daemon);
  }
  if (rig) alarm.look(*rig);
  return rig;
}

Result<v1::Rig> stop_and_wait(const Program& program, StopAlarm& alarm) {
  client::Connection daemon = program.uninterrupted();
  HP_RETURN_IF_ERROR(client::stop_rig(daemon));
  return wait_for_rest(program, alarm);
}

Result<v1::Rig> wait_for_motion(Program& program, Result<v1::Rig> begun) {
  RigDisplay display(STDERR_FILENO);
  StopAlarm alarm;
  std::uint64_t number = 0;
  Status followed;
  if (begun) {
    number = begun->motion().number();
    followed = client::watch_rig(program.daemon(), kRate_hz, [&](const v1::Rig& rig) {
      begun = rig;
      alarm.look(rig);
      if (is_over(rig, number)) return false;
      display.update(rig);
      return true;
    });
  } else {
    followed = tl::unexpected(begun.error());
  }
  if (followed) {
    HP_RETURN_IF_ERROR(judge(*begun, number));
    return begun;
  }
  if (followed.error().code == Code::kCancelled)
    return tl::unexpected(stopped_on_request(program, alarm));
  if (followed.error().code == Code::kUnavailable) return tl::unexpected(lost(followed.error()));
  return tl::unexpected(std::move(followed).error());
}

}  // namespace hydroprint::cli
