#include "hardware/rig/order_checks.h"

#include <chrono>
#include <cmath>

#include "hardware/rig/limits.h"

namespace hydroprint::rig {
namespace {

// Age at which an order is refused: the person who gave it may have left.
constexpr double kOldest_s = 1;

double age_s(const Order& order) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - order.given).count();
}

}  // namespace

Status check_order(const Order& order, std::uint64_t stops, const RigConfig& config,
                   const drive::DriveProfile& profile,
                   const std::optional<drive::DriveState>& axis) {
  if (order.stops != stops)
    return aborted("a stop was requested after this command; repeat the command");
  const bool jogs = order.kind == Event::Kind::kJog;
  if (age_s(order) > (jogs ? kPresence_s : kOldest_s)) {
    return aborted("the command waited too long to start safely; repeat it");
  }
  if (order.plan.motion == Motion::kNone) return {};
  HP_RETURN_IF_ERROR(check(config, order.plan));
  if (!jogs || !axis) return {};
  if (may_jog(config, profile, axis->position_mm, order.plan.jog_mm_per_s)) return {};
  return check_target(
      config, axis->position_mm + std::copysign(config.keep_out_mm, order.plan.jog_mm_per_s));
}

tl::unexpected<Error> aborted(const std::string& why) {
  return fail(Code::kAborted, why, ErrorReason::STATE_FORBIDS);
}

Error after_start(Error error) {
  if (error.code == Code::kUnavailable) error.code = Code::kFailedPrecondition;
  return error;
}

}  // namespace hydroprint::rig
