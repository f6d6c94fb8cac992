#include "client/cli/rig_session/jogger.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

constexpr double kLeast_mm_per_s = 0.05;
constexpr double kMost_mm_per_s = 100;  // the rig enforces its own limit and reports it

// Returns whether a refusal is temporary: jogging in the other direction is possible, or a motion
// has to end first.
bool passes(const Error& error) {
  return error.code == Code::kAborted || error.reason == ErrorReason::LIMIT_EXCEEDED;
}

bool may_have_moved(const Error& error) {
  return error.code == Code::kUnavailable || error.code == Code::kCancelled;
}

}  // namespace

Jogger::Jogger(client::Connection& daemon, std::string lease_id, double speed_mm_per_s)
    : daemon_(daemon), lease_id_(std::move(lease_id)), speed_mm_per_s_(speed_mm_per_s) {}

Jogger::~Jogger() {
  if (!moved_) return;
  // The stop is sent on a connection that Ctrl-C does not cancel.
  client::ConnectionOptions options = daemon_.options();
  options.stop = {};
  client::Connection daemon(std::move(options));
  // if this fails, the daemon stops the axis by itself
  static_cast<void>(client::stop_rig(daemon));
}

void Jogger::press(Key key, TimePoint now) {
  const int before = direction_;
  direction_ = key == Key::kDown ? 1 : key == Key::kUp ? -1 : 0;
  pressed_ = now;
  if (direction_ != before) last_sent_ = {};
  if (key == Key::kFaster) speed_mm_per_s_ = std::min(2 * speed_mm_per_s_, kMost_mm_per_s);
  if (key == Key::kSlower) speed_mm_per_s_ = std::max(speed_mm_per_s_ / 2, kLeast_mm_per_s);
}

Result<std::optional<v1::Rig>> Jogger::tick(TimePoint now) {
  if (now - pressed_ > kHeldFor) direction_ = 0;
  if (direction_ == 0) return release();
  if (now - last_sent_ < kPeriod) return std::nullopt;
  last_sent_ = now;
  auto rig = client::jog_rig(daemon_, lease_id_, direction_ * speed_mm_per_s_);
  // After a refused jog no stop is needed, and a stop might affect another user's motion.
  moved_ = moved_ || rig || may_have_moved(rig.error());
  refusal_ = rig ? "" : rig.error().message;
  if (rig) return std::move(*rig);
  if (passes(rig.error())) return std::nullopt;
  return tl::unexpected(std::move(rig).error());
}

Result<std::optional<v1::Rig>> Jogger::release() {
  if (!std::exchange(moved_, false)) return std::nullopt;
  HP_ASSIGN_OR_RETURN(auto rig, client::stop_rig(daemon_));
  return rig;
}

std::string Jogger::text() const {
  if (!refusal_.empty()) return refusal_;
  const char* what = direction_ > 0 ? "down" : direction_ < 0 ? "up" : "jog";
  return fmt::format("{} at {:.2f} mm/s", what, speed_mm_per_s_);
}

}  // namespace hydroprint::cli
