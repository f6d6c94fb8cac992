#include "daemon/dip/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hardware/rig/limits.h"
#include "hardware/rig/motion_profile.h"

namespace hydroprint::dip {
namespace {

// Duration that the progress assumes for a step of the operator.
constexpr double kOperator_s = 15;

tl::unexpected<Error> out_of_reach(std::string message, double value_mm, rig::Range range) {
  return rig::limit_exceeded("position", std::move(message), value_mm, range);
}

/// Returns the distance above first contact that the descent needs for acceleration, so that the
/// speed is constant when the object meets the water.
double run_up_mm(const Plan& plan, const drive::DriveProfile& profile) {
  const double ramp_mm =
      plan.speed_mm_per_s * plan.speed_mm_per_s / (2 * profile.acceleration_mm_per_s2);
  return std::max(kLeastClearance_mm, 2 * ramp_mm);
}

double travel_s(double from_mm, double to_mm, double speed_mm_per_s,
                double acceleration_mm_per_s2) {
  return rig::Travel(from_mm, to_mm, speed_mm_per_s, acceleration_mm_per_s2).duration_s();
}

Ways guess(const Plan& plan) { return {-plan.clearance_mm, plan.depth_mm, -plan.clearance_mm}; }

double contact_of(const Plan& plan, const Ways& ways) { return ways.bottom_mm - plan.depth_mm; }

}  // namespace

Status check(const Plan& plan, const rig::RigConfig& config) {
  HP_RETURN_IF_ERROR(rig::check_speed(config, plan.speed_mm_per_s));
  HP_RETURN_IF_ERROR(rig::check_speed(config, plan.retract_speed_mm_per_s));
  const rig::Range range = rig::soft_limits(config);
  const double most_mm = range.high_mm - range.low_mm - kLeastClearance_mm;
  if (plan.depth_mm <= most_mm) return {};
  return out_of_reach(
      fmt::format("a depth of {:g} mm is more than this rig can reach; dip at most {:g} mm deep",
                  plan.depth_mm, most_mm),
      plan.depth_mm, {0, most_mm});
}

Result<Ways> ways_from(const Plan& plan, double contact_mm, double loaded_mm,
                       const rig::RigConfig& config, const drive::DriveProfile& profile) {
  const rig::Range range = rig::soft_limits(config);
  Ways ways;
  ways.bottom_mm = contact_mm + plan.depth_mm;
  if (!(ways.bottom_mm <= range.high_mm)) {
    return out_of_reach(
        fmt::format("with first contact at {:g} mm, a depth of {:g} mm ends at {:g} "
                    "mm, which exceeds the limit of {:g} mm; mount the object lower in "
                    "the gripper, or dip less deep",
                    contact_mm, plan.depth_mm, ways.bottom_mm, range.high_mm),
        ways.bottom_mm, range);
  }
  ways.clear_mm = std::max(contact_mm - plan.clearance_mm, range.low_mm);
  const double needed_mm = run_up_mm(plan, profile);
  if (!(contact_mm - ways.clear_mm >= needed_mm)) {
    return out_of_reach(
        fmt::format(
            "with first contact at {:g} mm, the descent starts less than {:g} mm above the water, "
            "too close for its acceleration (the axis ends at {:g} mm); mount the object higher in "
            "the gripper, or set a larger clearance or a lower speed",
            contact_mm, needed_mm, range.low_mm),
        contact_mm, {range.low_mm + needed_mm, range.high_mm});
  }
  ways.up_mm = std::max(std::min(loaded_mm, ways.clear_mm), range.low_mm);
  return ways;
}

rig::Leg rise(const Plan& plan, const Ways& ways) {
  return {ways.clear_mm, plan.retract_speed_mm_per_s, 0};
}

std::vector<rig::Leg> legs(const Plan& plan, const Ways& ways) {
  return {{ways.bottom_mm, plan.speed_mm_per_s, plan.hold_s},
          {ways.up_mm, plan.retract_speed_mm_per_s, 0}};
}

double planned_s(Step step, const Plan& plan, const std::optional<Ways>& ways,
                 double acceleration_mm_per_s2) {
  const Ways way = ways.value_or(guess(plan));
  switch (step) {
    case Step::kClear:
      return travel_s(contact_of(plan, way), way.clear_mm, plan.retract_speed_mm_per_s,
                      acceleration_mm_per_s2);
    case Step::kSoak:
      return plan.clocks.skip ? 0 : plan.clocks.soak_s;
    case Step::kActivate:
      return plan.clocks.skip ? 0 : plan.clocks.activator_wait_s;
    case Step::kDescend:
      return travel_s(way.clear_mm, way.bottom_mm, plan.speed_mm_per_s, acceleration_mm_per_s2);
    case Step::kHold:
      return plan.hold_s;
    case Step::kRetract:
      return travel_s(way.bottom_mm, way.up_mm, plan.retract_speed_mm_per_s,
                      acceleration_mm_per_s2);
    default:
      return 0;
  }
}

ProgressEstimate estimate_progress(const Stand& stand, double time_s, const Plan& plan,
                                   const std::optional<Ways>& ways, double acceleration_mm_per_s2) {
  ProgressEstimate out;
  double all_s = 0, done_s = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const auto step = static_cast<Step>(i);
    const double planned = planned_s(step, plan, ways, acceleration_mm_per_s2);
    const bool counts = awaits(step) == Awaits::kOperator && !plan.clocks.skip;
    const double weight_s = counts ? kOperator_s : planned;
    all_s += weight_s;
    if (step < stand.step) done_s += weight_s;
    if (step > stand.step) out.remaining_s += planned;
    if (step != stand.step || planned <= 0) continue;
    const double elapsed_s = std::clamp(time_s - stand.since_s, 0.0, planned);
    out.step_fraction = elapsed_s / planned;
    out.remaining_s += planned - elapsed_s;
    done_s += elapsed_s;
  }
  out.fraction = all_s > 0 ? done_s / all_s : 0;
  return out;
}

}  // namespace hydroprint::dip
