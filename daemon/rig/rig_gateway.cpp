#include "daemon/rig/rig_gateway.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "daemon/platform/clock.h"
#include "daemon/platform/resource_names.h"
#include "hardware/rig/errors.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kMostStops = 64;
// After this time a jog that was not requested again has ended, or is at least coming to rest.
constexpr std::int64_t kJogMemoryMs = static_cast<std::int64_t>(1000 * rig::kPresence_s) + 50;

std::int64_t steady_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace

tl::unexpected<Error> no_rig() {
  return tl::unexpected(
      Error{Code::kFailedPrecondition,
            "no rig is configured; set rig.drive and rig.profile, or start hydroprintd with --rig "
            "and --rig-profile",
            ErrorReason::RIG_OFFLINE,
            {{"state", "OFFLINE"}}});
}

Status RigGateway::check_free() const {
  if (controller_ == nullptr) return no_rig();
  if (!claimed_) return {};
  const std::string name = job_name(dip_);
  return tl::unexpected(Error{
      Code::kFailedPrecondition,
      fmt::format(
          "the dip {} has exclusive use of the rig until it ends; stop the rig or cancel the dip",
          name),
      ErrorReason::STATE_FORBIDS,
      {{"dip", name}}});
}

Result<std::future<rig::Answer>> RigGateway::order(const std::string& lease_id,
                                                   const Order& order) {
  return leases_.with(lease_id, [&]() -> Result<std::future<rig::Answer>> {
    HP_RETURN_IF_ERROR(check_free());
    return order(*controller_);
  });
}

Result<std::future<rig::Answer>> RigGateway::jog(const std::string& lease_id,
                                                 double speed_mm_per_s) {
  return order(lease_id, [&](rig::Controller& controller) {
    jogged_ms_ = steady_ms();
    return controller.jog(speed_mm_per_s);
  });
}

void RigGateway::note_stop(const std::string& who) {
  const std::lock_guard lock(stops_mutex_);
  if (stops_.size() < kMostStops) stops_.push_back(who);
}

std::vector<std::string> RigGateway::take_stops() {
  const std::lock_guard lock(stops_mutex_);
  return std::exchange(stops_, {});
}

void RigGateway::read_in_order(const std::function<void(std::int64_t revision)>& read) const {
  const std::lock_guard lock(revision_mutex_);
  revision_ = std::max(revision_ + 1, 1000 * system_clock_ms());
  read(revision_);
}

bool RigGateway::jogged_lately() const {
  const std::int64_t jogged_ms = jogged_ms_;
  return jogged_ms != 0 && steady_ms() - jogged_ms < kJogMemoryMs;
}

// A dip in progress continues: the rig was at rest before it, and the dip has had exclusive use
// since then.
void RigGateway::end_jog() {
  if (controller_ == nullptr || claimed_) return;
  if (jogged_lately() || controller_->snapshot().condition.motion == rig::Motion::kJog) {
    controller_->stop();
  }
}

Status RigGateway::check_at_rest() const {
  if (controller_ == nullptr) return no_rig();
  const rig::Condition condition = controller_->snapshot().condition;
  auto refusal = rig::step(condition, {rig::Event::Kind::kMove}).refusal;
  if (!refusal && jogged_lately()) refusal = rig::Refusal::kMotionInProgress;
  if (!refusal) return {};
  return tl::unexpected(rig::refused(*refusal, condition));
}

}  // namespace hydroprint::daemon
