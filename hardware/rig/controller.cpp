#include "hardware/rig/controller.h"

#include <thread>
#include <utility>

#include "hardware/rig/control_loop.h"

namespace hydroprint::rig {
namespace {

using Kind = Event::Kind;

constexpr std::chrono::milliseconds kConnect{200};

}  // namespace

struct Controller::Impl {
  Impl(const RigConfig& c, drive::DriveProfile profile, std::shared_ptr<drive::Link> link)
      : config(c),
        drive(std::move(profile), std::move(link)),
        stop_channel(drive),
        owner(config, drive, stop_channel, shared),
        thread([this] { owner.run(); }) {}

  RigConfig config;
  SharedState shared;
  drive::Drive drive;
  StopChannel stop_channel;
  ControlLoop owner;
  std::thread thread;
};

Controller::Controller() = default;

Controller::~Controller() {
  if (!impl_) return;
  impl_->shared.end = true;
  impl_->thread.join();
}

Result<std::unique_ptr<Controller>> Controller::make(const RigConfig& config,
                                                     drive::DriveProfile profile,
                                                     drive::Endpoint endpoint) {
  HP_RETURN_IF_ERROR(check(config, profile));
  const drive::LinkTiming timing{kConnect, profile.response_timeout, profile.worst_delay,
                                 profile.bus};
  auto link = std::make_shared<drive::Link>(std::move(endpoint), timing);
  std::unique_ptr<Controller> out(new Controller);
  out->impl_ = std::make_unique<Impl>(config, std::move(profile), std::move(link));
  return out;
}

std::future<Answer> Controller::order(Event::Kind kind, Plan plan) {
  Order order{kind, std::move(plan), std::chrono::steady_clock::now(), impl_->shared.stops, {}};
  std::future<Answer> answer = order.answer.get_future();
  if (!impl_->shared.orders.put(order)) {
    order.answer.set_value(fail(Code::kResourceExhausted,
                                "too many commands are waiting for the rig; try again in a moment",
                                ErrorReason::QUEUE_FULL));
  }
  return answer;
}

std::future<Answer> Controller::arm() { return order(Kind::kArm); }
std::future<Answer> Controller::disarm() { return order(Kind::kDisarm); }
std::future<Answer> Controller::reset() { return order(Kind::kReset); }
std::future<Answer> Controller::home() { return order(Kind::kHome, {Motion::kHome}); }

std::future<Answer> Controller::move_to(double position_mm, double speed_mm_per_s) {
  return order(Kind::kMove, {Motion::kMove, {{position_mm, speed_mm_per_s}}});
}

std::future<Answer> Controller::jog(double speed_mm_per_s) {
  return order(Kind::kJog, {Motion::kJog, {}, speed_mm_per_s});
}

std::future<Answer> Controller::dip(std::vector<Leg> legs) {
  return order(Kind::kDip, {Motion::kDip, std::move(legs)});
}

void Controller::stop() noexcept {
  ++impl_->shared.stops;
  impl_->stop_channel.stop();
}

Snapshot Controller::snapshot() const { return impl_->shared.status.snapshot.load(); }
std::optional<Error> Controller::trouble() const { return impl_->shared.status.trouble(); }

std::optional<MotionReport> Controller::motion(std::uint64_t number) const {
  return impl_->shared.status.motion(number);
}

std::vector<Sample> Controller::samples(std::uint64_t first, std::uint64_t last) const {
  return impl_->shared.status.samples.copy(first, last);
}

const RigConfig& Controller::config() const { return impl_->config; }
const drive::DriveProfile& Controller::profile() const { return impl_->drive.profile(); }

}  // namespace hydroprint::rig
