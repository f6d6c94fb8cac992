// How the owner of the drive carries out orders.
#include <cmath>
#include <utility>

#include "hardware/rig/errors.h"
#include "hardware/rig/limits.h"
#include "hardware/rig/owner.h"

namespace hydroprint::rig {
namespace {

using Clock = std::chrono::steady_clock;
using Kind = Event::Kind;

// An order that was given longer ago is not carried out: who gave it may have gone.
constexpr double kOldest_s = 1;

double seconds_since(TimePoint time) {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

tl::unexpected<Error> aborted(const std::string& why) {
  return fail(Code::kAborted, why, "STATE_FORBIDS");
}

/// Something may have moved: nothing that invites to try again blindly.
Error after_start(Error error) {
  if (error.code == Code::kUnavailable) error.code = Code::kFailedPrecondition;
  return error;
}

}  // namespace

void Owner::take_orders() {
  if (stopper_.is_busy()) return;  // at the next look
  for (Order& order : desk_.orders.take()) carry_out(order);
}

void Owner::answer(Order& order, Answer answer) {
  answers_.emplace_back(std::move(order.answer), std::move(answer));
}

/// What is wrong with an order, apart from the state of the rig.
Status Owner::check_order(const Order& order) const {
  if (order.stops != desk_.stops) return aborted("a stop was asked for after this; order it again");
  const bool jogs = order.kind == Kind::kJog;
  if (seconds_since(order.given) > (jogs ? kPresence_s : kOldest_s)) {
    return aborted("the rig was busy too long to begin this safely; order it again");
  }
  if (order.plan.motion == Motion::kNone) return {};
  HP_RETURN_IF_ERROR(check(config_, order.plan));
  if (!jogs || !axis_) return {};
  if (may_jog(config_, drive_.profile(), axis_->position_mm, order.plan.jog_mm_per_s)) return {};
  return check_target(
      config_, axis_->position_mm + std::copysign(config_.keep_out_mm, order.plan.jog_mm_per_s));
}

void Owner::carry_out(Order& order) {
  if (const auto refusal = step(condition_, {order.kind}).refusal) {
    const auto& trouble = lookout_.trouble();
    const bool says_more =
        trouble && (*refusal == Refusal::kOffline || *refusal == Refusal::kConfigUnsafe);
    Error error = says_more ? after_start(*trouble) : refused(*refusal, condition_);
    error.metadata["state"] = name(condition_.state);
    answer(order, tl::unexpected(std::move(error)));
    return;
  }
  if (Status sound = check_order(order); !sound) {
    answer(order, tl::unexpected(std::move(sound).error()));
    return;
  }
  if (apply({order.kind}).actions.start) {
    answer(order, begin(order));
  } else {
    waiting_.push_back(std::move(order));
    answer_waiting();
  }
}

Answer Owner::begin(const Order& order) {
  if (course_) {  // a jog that goes on
    course_->hold_jog(order.given, order.plan.jog_mm_per_s);
  } else {
    const TimePoint now = Clock::now();
    course_.emplace(config_, drive_.profile(), order.plan, now, axis_->position_mm);
    if (order.kind == Kind::kJog) course_->hold_jog(order.given, order.plan.jog_mm_per_s);
    log_.begin(order.plan.motion, now, axis_->position_mm);
  }
  if (Status sent = command(order); !sent) {
    apply({Kind::kStop});  // perhaps it did arrive
    return tl::unexpected(after_start(std::move(sent).error()));
  }
  return log_.latest();
}

Status Owner::command(const Order& order) {
  if (order.kind == Kind::kHome) return drive_.home();
  if (order.kind != Kind::kJog) return command_leg(order.plan.legs.front());
  jogged_ = Clock::now();
  return drive_.jog(order.plan.jog_mm_per_s);
}

Status Owner::command_leg(const Leg& leg) {
  HP_RETURN_IF_ERROR(drive_.move_to(leg.target_mm, leg.speed_mm_per_s));
  course_->begin_leg(Clock::now());
  return {};
}

/// Answers who waits for what is pending no longer.
void Owner::answer_waiting() {
  if (condition_.pending != Pending::kNone) return;
  for (Order& order : std::exchange(waiting_, {})) {
    const bool failed = (order.kind == Kind::kArm && !is_armed(condition_.state)) ||
                        (order.kind == Kind::kReset && condition_.cause != Cause::kNone);
    if (!failed) {
      answer(order, 0);
      continue;
    }
    Error error{Code::kAborted,
                "the drive did not confirm it; look at its display and order it again",
                "STATE_FORBIDS",
                {{"state", std::string(name(condition_.state))}}};
    answer(order, tl::unexpected(std::move(error)));
  }
}

void Owner::refuse_all() {
  std::deque<Order> orders = desk_.orders.take_all();
  for (Order& order : waiting_) orders.push_back(std::move(order));
  waiting_.clear();
  for (Order& order : orders) order.answer.set_value(aborted("the rig is being let go of"));
}

}  // namespace hydroprint::rig
