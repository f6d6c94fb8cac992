#include "hardware/drive/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hardware/drive/command_encoder.h"
#include "hardware/drive/link_budget.h"
#include "hardware/drive/state_decoder.h"
#include "hardware/drive/word_codec.h"

namespace hydroprint::drive {
namespace {

using Clock = std::chrono::steady_clock;

Error unsafe(const std::string& what) {
  return {Code::kFailedPrecondition, what, ErrorReason::DRIVE_CONFIG_UNSAFE, {}};
}

/// Returns whether the drive responded despite the error, so that its state is still known.
bool is_answer(const Error& error) {
  return error.reason == ErrorReason::DRIVE_REFUSED || error.reason == ErrorReason::DRIVE_BUSY ||
         error.reason == ErrorReason::LIMIT_EXCEEDED;
}

/// Returns whether a reply was damaged, missing or late.
bool is_bad_reply(const Error& error) {
  return error.reason == ErrorReason::REPLY_INVALID || error.metadata.contains("timeout");
}

std::optional<Error> judge_time(const DriveProfile& profile, double time_s) {
  const Watchdog& watchdog = *profile.watchdog;
  if (time_s != 0 && time_s <= watchdog.largest_time_s) return std::nullopt;
  return unsafe(fmt::format(
      "the communication watchdog of {} {}. Set it to at most {:g} s in register {:#06x}",
      profile.name, time_s == 0 ? "is off" : fmt::format("waits {:g} s", time_s),
      watchdog.largest_time_s, watchdog.time.address));
}

}  // namespace

Drive::Drive(DriveProfile profile, std::shared_ptr<Link> link)
    : profile_(std::move(profile)), link_(std::move(link)) {}

template <class T>
Result<T> Drive::noted(Result<T> result) {
  if (!result && !is_answer(result.error())) known_ = false;
  return result;
}

Request Drive::read_request(Space space, std::uint16_t address, std::uint16_t count) const {
  const Function function =
      space == Space::kHolding ? Function::kReadHolding : Function::kReadInput;
  return {profile_.unit, function, address, count, {}};
}

Result<std::vector<std::uint16_t>> Drive::read(Space space, std::uint16_t address,
                                               std::uint16_t count) {
  return noted(link_->transact(read_request(space, address, count)));
}

Result<Inspection> Drive::connect() {
  known_ = false;
  last_.reset();
  unsafe_.reset();
  HP_RETURN_IF_ERROR(link_->connect());
  connection_ = link_->connections();
  auto found = check_identity().and_then([this] { return inspect_watchdog(); });
  if (!found) {
    disconnect();
    if (auto trouble = find_rtu_over_tcp(found.error())) return tl::unexpected(*trouble);
    return found;
  }
  unsafe_ = found->unsafe;
  return found;
}

/// Examines why a drive over TCP has never replied: reads its identity in an RTU frame, over
/// another connection. Returns the error with the remedy if that is answered.
std::optional<Error> Drive::find_rtu_over_tcp(const Error& error) const {
  if (link_->endpoint().serial || link_->timing().bus.rtu_over_tcp ||
      !error.metadata.contains("timeout") || link_->statistics().has_replies()) {
    return std::nullopt;
  }
  LinkTiming timing = link_->timing();
  timing.bus.rtu_over_tcp = true;
  Link other(link_->endpoint(), timing);
  if (!other.connect()) return std::nullopt;
  const Mark& mark = profile_.identity.front();
  (void)other.transact(read_request(mark.space, mark.address, 1));
  if (!other.statistics().has_replies()) return std::nullopt;
  return Error{Code::kUnavailable,
               "the gateway at " + link_->endpoint().text() +
                   " speaks Modbus RTU over TCP. Set rtu_over_tcp = true in the drive's profile",
               ErrorReason::RIG_OFFLINE,
               {}};
}

void Drive::disconnect() {
  known_ = false;
  link_->close();
}

bool Drive::connected() const { return link_->is_open() && link_->connections() == connection_; }

Status Drive::check_identity() {
  for (const Mark& mark : profile_.identity) {
    const auto words = read(mark.space, mark.address, 1);
    if (!words && words.error().reason != ErrorReason::DRIVE_REFUSED)
      return tl::unexpected(words.error());
    if (words && ((*words)[0] & mark.mask) == mark.value) continue;
    return tl::unexpected(
        unsafe(fmt::format("register {:#06x} ({}) {}; {:#06x} is expected, so the drive is not a "
                           "{}. Use the profile of the connected "
                           "drive",
                           mark.address, mark.meaning,
                           words ? fmt::format("holds {:#06x}", (*words)[0]) : "does not exist",
                           mark.value, profile_.name)));
  }
  return {};
}

Result<Inspection> Drive::inspect_watchdog() {
  Inspection out{profile_.name, 0, {}};
  if (!profile_.watchdog) {
    out.unsafe = unsafe(profile_.name +
                        " has no communication watchdog: it would not stop when the connection is "
                        "lost. Use another drive");
    return out;
  }
  const Watchdog& watchdog = *profile_.watchdog;
  const auto count = static_cast<std::uint16_t>(watchdog.time.format.words);
  HP_ASSIGN_OR_RETURN(const auto time, read(watchdog.time.space, watchdog.time.address, count));
  out.watchdog_s = decode(watchdog.time.format, time);
  out.unsafe = judge_time(profile_, out.watchdog_s);
  if (!watchdog.action) return out;
  HP_ASSIGN_OR_RETURN(const auto action, read(watchdog.action->space, watchdog.action->address, 1));
  const auto& stopping = watchdog.stopping;
  if (!out.unsafe && std::find(stopping.begin(), stopping.end(), action[0]) == stopping.end()) {
    out.unsafe = unsafe(fmt::format(
        "the communication watchdog of {} does not stop the axis: its action, register {:#06x}, is "
        "{}. Set an action that stops the axis (see the drive's manual)",
        profile_.name, watchdog.action->address, action[0]));
  }
  return out;
}

/// Reads some of a block's registers into their places and checks the mark if it is among them.
Status Drive::read_part(const Block& block, const Part& part, Polled& polled) {
  const auto sent = Clock::now();
  HP_ASSIGN_OR_RETURN(const auto words, read(block.space, part.address, part.count));
  const auto got = Clock::now();
  const int mark = block.mark.address - part.address;
  if (mark >= 0 && mark < part.count &&
      (words[static_cast<std::size_t>(mark)] & block.mark.mask) != block.mark.value) {
    known_ = false;
    link_->distrust(read_request(block.space, part.address, part.count));
    return fail(Code::kDataLoss,
                fmt::format("a reply of {} lacks its mark ({}, register {:#06x}) and belongs to "
                            "another request. Poll again",
                            profile_.name, block.mark.meaning, block.mark.address),
                ErrorReason::REPLY_INVALID);
  }
  std::copy(words.begin(), words.end(),
            polled.blocks.back().begin() + part.address - block.address);
  if (holds({block.space, part.address, part.count, {}}, profile_.position)) {
    polled.time = sent + (got - sent) / 2;
    polled.spread = (got - sent) / 2;
  }
  return {};
}

Status Drive::read_parts(const Block& block, bool whole, Polled& polled) {
  const Part all{block.address, block.count};
  for (const Part& part : whole ? std::vector{all} : parts_of(profile_, block)) {
    HP_RETURN_IF_ERROR(read_part(block, part, polled));
  }
  return {};
}

/// Reads a block: whole, or in parts as long as a late reply could be taken for that of the whole
/// block. After a bad reply, reads it once more the other way; for one block of each poll.
Status Drive::read_block(const Block& block, Polled& polled) {
  polled.blocks.emplace_back(block.count);
  const bool whole = !link_->may_be_confused(read_request(block.space, block.address, block.count));
  Status done = read_parts(block, whole, polled);
  const bool may_repeat = !polled.repeated && Clock::now() < polled.repeat_until;
  if (done || !may_repeat || !is_bad_reply(done.error())) return done;
  polled.repeated = true;
  link_->count_retry();
  if (!read_parts(block, !whole, polled)) return done;  // the first error names the cause
  return {};
}

Result<DriveState> Drive::poll(Clock::time_point repeat_until) {
  if (!connected()) {
    known_ = false;
    return fail(Code::kUnavailable, profile_.name + " is not connected. Connect to it first",
                ErrorReason::RIG_OFFLINE);
  }
  Polled polled;
  polled.repeat_until = repeat_until;
  for (const Block& block : profile_.blocks) HP_RETURN_IF_ERROR(read_block(block, polled));
  DriveState state = decode_state(profile_, polled.blocks);
  state.time = polled.time;
  state.time_error = polled.spread;
  if (!profile_.velocity) state.velocity_mm_per_s = derive_velocity(state);
  known_ = true;
  return state;
}

double Drive::derive_velocity(const DriveState& state) {
  const auto last = std::exchange(last_, std::pair(state.position_mm, state.time));
  if (!last) return 0;
  const double passed_s = std::chrono::duration<double>(state.time - last->second).count();
  return passed_s > 0 && passed_s <= kStale_s ? (state.position_mm - last->first) / passed_s : 0;
}

Status Drive::may_move() const {
  if (unsafe_) return tl::unexpected(*unsafe_);
  if (known_ && connected()) return {};
  return fail(Code::kUnavailable,
              "the state of " + profile_.name + " is unknown after a failure. Poll the drive first",
              ErrorReason::RIG_OFFLINE);
}

Status Drive::command(Command which, double position_mm, double speed_mm_per_s) {
  HP_ASSIGN_OR_RETURN(const auto requests,
                      requests_for(profile_, which, position_mm, speed_mm_per_s));
  for (const Request& request : requests) {
    HP_RETURN_IF_ERROR(noted(link_->transact(request)));
  }
  return {};
}

Status Drive::enable() {
  HP_RETURN_IF_ERROR(may_move());
  return command(Command::kEnable, 0, 0);
}

Status Drive::disable() { return command(Command::kDisable, 0, 0); }

Status Drive::home() {
  HP_RETURN_IF_ERROR(may_move());
  return command(Command::kHome, 0, 0);
}

Status Drive::move_to(double position_mm, double speed_mm_per_s) {
  HP_RETURN_IF_ERROR(may_move());
  return command(Command::kMove, position_mm, speed_mm_per_s);
}

Status Drive::jog(double speed_mm_per_s) {
  HP_RETURN_IF_ERROR(may_move());
  return command(speed_mm_per_s < 0 ? Command::kJogNegative : Command::kJogPositive, 0,
                 std::abs(speed_mm_per_s));
}

Status Drive::stop() { return command(Command::kStop, 0, 0); }

Status Drive::reset_fault() { return command(Command::kResetFault, 0, 0); }

}  // namespace hydroprint::drive
