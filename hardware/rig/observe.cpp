#include "hardware/rig/observe.h"

#include <algorithm>
#include <cmath>

namespace hydroprint::rig {
namespace {

using Samples = std::span<const AxisSample>;
using Found = std::optional<Cause>;

// Distances below this are never a jump, and never a disagreement of position and velocity.
constexpr double kDistance_mm = 0.5;
// An axis accelerates at most at this multiple of its ramps.
constexpr double kHardest = 5;
// Delay of a drive's velocity behind its position: a filter.
constexpr double kVelocityLag_s = 0.05;
// Error of a velocity, as a share: rounding, and a scale that is not exact.
constexpr double kVelocityShare = 0.15;
// Overspeed: share of the ordered speed and absolute speed above it.
constexpr double kOverspeedShare = 0.25;
constexpr double kOverspeed_mm_per_s = 1;
// Time between an order and the drive's reaction.
constexpr double kReaction_s = 0.1;
// Progress of a jog: share of the ordered distance within this time, or over this distance.
constexpr double kProgressShare = 0.25;
constexpr double kProgress_s = 0.15;
constexpr double kLeastProgress_mm = 0.3;
// Without progress, this way back within this time tells the wrong direction from standstill.
constexpr double kLatest_s = 0.04;
constexpr double kLatest_mm = 0.05;
// Samples further apart are not compared: too much may have happened between them.
constexpr double kGap_s = 0.1;
// Time after which an acknowledged stop must show, and the share by which the axis must then have
// slowed down.
constexpr double kStopShows_s = 0.15;
constexpr double kSlowed = 0.2;
// Lower speeds count as rest.
constexpr double kRest_mm_per_s = 0.2;

double hardest_mm_per_s2(const drive::DriveProfile& profile) {
  return kHardest *
         std::max(profile.acceleration_mm_per_s2, profile.stopping_deceleration_mm_per_s2);
}

/// Whether the axis cannot have moved from `a` to `b` in the time between, given the velocities.
/// A velocity that was derived from `b` cannot explain it.
bool is_unexplained(const drive::DriveProfile& profile, const AxisSample& a, const AxisSample& b) {
  const double dt_s = seconds(a.time, b.time);
  const double v_mm_per_s =
      std::max(std::abs(a.velocity_mm_per_s), profile.velocity ? std::abs(b.velocity_mm_per_s) : 0);
  const double reach_mm = kDistance_mm + v_mm_per_s * (dt_s + a.time_error_s + b.time_error_s) +
                          hardest_mm_per_s2(profile) * dt_s * dt_s / 2;
  return !(std::abs(b.position_mm - a.position_mm) <= reach_mm);
}

/// A step that cannot be motion is a jump, two in a row are motion that the velocity does not show.
/// In homing, a jump sets the position to zero.
Found look_for_jump(const drive::DriveProfile& profile, const AxisOrder& order, Samples samples) {
  const std::size_t n = samples.size();
  if (n < 3 || !is_unexplained(profile, samples[n - 3], samples[n - 2])) return std::nullopt;
  if (is_unexplained(profile, samples[n - 2], samples[n - 1])) return Cause::kFeedback;
  if (order.motion == Motion::kHome) return std::nullopt;
  return Cause::kPositionJumped;
}

/// Compares the distance with the integral of the velocity, over all times until now.
Found compare_feedback(const drive::DriveProfile& profile, const AxisOrder& order,
                       Samples samples) {
  if (!profile.velocity) return std::nullopt;
  double integral_mm = 0, path_mm = 0, fastest_mm_per_s = 0;
  for (std::size_t i = samples.size() - 1; i > 0; --i) {
    const AxisSample &a = samples[i - 1], &b = samples[i];
    const double dt_s = seconds(a.time, b.time);
    const bool is_zeroed = order.motion == Motion::kHome && is_unexplained(profile, a, b);
    if (dt_s > kGap_s || is_zeroed) return std::nullopt;
    integral_mm += dt_s * (a.velocity_mm_per_s + b.velocity_mm_per_s) / 2;
    path_mm += dt_s * (std::abs(a.velocity_mm_per_s) + std::abs(b.velocity_mm_per_s)) / 2;
    fastest_mm_per_s =
        std::max({fastest_mm_per_s, std::abs(a.velocity_mm_per_s), std::abs(b.velocity_mm_per_s)});
    const double way_mm = samples.back().position_mm - a.position_mm;
    const double late_s = kVelocityLag_s + a.time_error_s + samples.back().time_error_s;
    const double band_mm = kDistance_mm + late_s * fastest_mm_per_s +
                           kVelocityShare * std::max(path_mm, std::abs(way_mm));
    if (!(std::abs(way_mm - integral_mm) <= band_mm)) return Cause::kFeedback;
  }
  return std::nullopt;
}

/// Two samples in a row must show it, because single values of an encoder may be wrong.
Found look_for_overspeed(const drive::DriveProfile& profile, const AxisOrder& order,
                         Samples samples) {
  const auto is_fast = [&](const AxisSample& sample) {
    const double most = speed_bound_mm_per_s(profile, order, sample.time);
    return std::abs(sample.velocity_mm_per_s) > (1 + kOverspeedShare) * most + kOverspeed_mm_per_s;
  };
  const bool both = is_fast(samples[samples.size() - 2]) && is_fast(samples.back());
  return both ? Found(Cause::kOverspeed) : std::nullopt;
}

/// Returns the way during the last `window_s`, towards the ordered direction; nullopt if the
/// samples do not cover it without a gap.
std::optional<double> way_mm(const AxisOrder& order, Samples samples, double window_s) {
  const double sign = order.speed_mm_per_s < 0 ? -1 : 1;
  for (std::size_t i = samples.size() - 1; i > 0; --i) {
    if (seconds(samples[i - 1].time, samples[i].time) > kGap_s) return std::nullopt;
    if (seconds(samples[i - 1].time, samples.back().time) >= window_s) {
      return sign * (samples.back().position_mm - samples[i - 1].position_mm);
    }
  }
  return std::nullopt;
}

/// The time that the axis needs to reach the ordered speed.
double ramp_s(const drive::DriveProfile& profile, const AxisOrder& order) {
  return kReaction_s +
         (order.entry_mm_per_s + std::abs(order.speed_mm_per_s)) / profile.acceleration_mm_per_s2;
}

/// A motion from standstill must not go back at all; one that was faster or turned may brake first.
bool goes_back(const drive::DriveProfile& profile, const AxisOrder& order, Samples samples) {
  const double allowed_s = order.entry_mm_per_s > 0 ? ramp_s(profile, order) : 0;
  const double window_s =
      std::min(seconds(order.turned, samples.back().time) - allowed_s, kReaction_s);
  if (window_s <= 0) return false;
  return way_mm(order, samples, window_s).value_or(0) < -kLeastProgress_mm;
}

Found look_for_progress(const drive::DriveProfile& profile, const AxisOrder& order,
                        Samples samples) {
  const double speed_mm_per_s = std::abs(order.speed_mm_per_s);
  const double window_s = std::max(kProgress_s, kLeastProgress_mm / speed_mm_per_s);
  if (seconds(order.since, samples.back().time) < ramp_s(profile, order) + window_s) {
    return std::nullopt;
  }
  const auto ahead_mm = way_mm(order, samples, window_s);
  if (!ahead_mm || *ahead_mm >= kProgressShare * speed_mm_per_s * window_s) return std::nullopt;
  const double told_mm_per_s =
      samples.back().velocity_mm_per_s * (order.speed_mm_per_s < 0 ? -1 : 1);
  if (told_mm_per_s >= speed_mm_per_s / 2) return Cause::kFeedback;
  const double now_mm = way_mm(order, samples, kLatest_s).value_or(0);
  return now_mm < -kLatest_mm ? Cause::kWrongDirection : Cause::kFollowingError;
}

/// The speed by velocity or position, whichever shows more.
double speed_mm_per_s(const AxisSample& a, const AxisSample& b) {
  const double dt_s = seconds(a.time, b.time);
  const double by_position = dt_s > 0 ? std::abs(b.position_mm - a.position_mm) / dt_s : 0;
  return std::max(std::abs(b.velocity_mm_per_s), by_position);
}

Found look_at_stop(const drive::DriveProfile& profile, const AxisOrder& order, Samples samples) {
  if (!order.stopped) return std::nullopt;
  const auto first = std::find_if(samples.begin(), samples.end(),
                                  [&](const AxisSample& s) { return s.time >= *order.stopped; });
  if (samples.end() - first < 4) return std::nullopt;
  const double before = speed_mm_per_s(*first, *(first + 1));
  const double after = speed_mm_per_s(samples[samples.size() - 2], samples.back());
  const double wait_s =
      std::max(kStopShows_s, 2 * kSlowed * before / profile.stopping_deceleration_mm_per_s2);
  if (seconds(first->time, samples.back().time) < wait_s || after <= kRest_mm_per_s) {
    return std::nullopt;
  }
  return after > (1 - kSlowed) * before ? Found(Cause::kStopNotObeyed) : std::nullopt;
}

bool is_at_rest(State state) { return state == State::kUnhomed || state == State::kIdle; }

}  // namespace

double speed_bound_mm_per_s(const drive::DriveProfile& profile, const AxisOrder& order,
                            TimePoint now) {
  const double braking_s = std::max(0.0, seconds(order.since, now) - kReaction_s);
  return std::max(std::abs(order.speed_mm_per_s),
                  order.entry_mm_per_s - profile.acceleration_mm_per_s2 * braking_s);
}

bool is_in_doubt(const drive::DriveProfile& profile, Samples samples) {
  const std::size_t n = samples.size();
  return n >= 2 && is_unexplained(profile, samples[n - 2], samples[n - 1]) &&
         (n < 3 || !is_unexplained(profile, samples[n - 3], samples[n - 2]));
}

std::optional<Cause> observe(const RigConfig& config, const drive::DriveProfile& profile,
                             const AxisOrder& order, Samples samples) {
  if (samples.size() < 2) return std::nullopt;
  if (order.state == State::kStopping) return look_at_stop(profile, order, samples);
  const bool moves = in_motion(order.state);
  if (!moves && !is_at_rest(order.state)) return std::nullopt;
  if (const Found jump = look_for_jump(profile, order, samples)) return jump;
  if (is_in_doubt(profile, samples)) return std::nullopt;
  if (!moves) {
    const double off_mm = std::abs(samples.back().position_mm - order.from_mm);
    return off_mm <= config.standstill_mm ? std::nullopt : Found(Cause::kUnexpectedMotion);
  }
  if (const Found differs = compare_feedback(profile, order, samples)) return differs;
  if (const Found fast = look_for_overspeed(profile, order, samples)) return fast;
  if (order.motion == Motion::kHome) return std::nullopt;
  if (goes_back(profile, order, samples)) return Cause::kWrongDirection;
  return order.motion == Motion::kJog ? look_for_progress(profile, order, samples) : std::nullopt;
}

}  // namespace hydroprint::rig
