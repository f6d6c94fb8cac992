#include "tests/hardware/simulator/drive/bench_rig.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "hardware/simulator/drive/virtual_rig.h"

namespace hydroprint::simulated_drive {
namespace {

constexpr auto kPollEvery = milliseconds(20);
constexpr auto kPatience = milliseconds(5000);

template <class T>
T need(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

drive::LinkTiming timing_of(const drive::DriveProfile& profile) {
  return {milliseconds(500), profile.response_timeout, profile.worst_delay};
}

}  // namespace

BenchRig::BenchRig(const std::string& wire, const BenchOptions& options) {
  Options rig;
  rig.profile = need(drive::read_drive_profile(options.profile));
  rig.scene.start_mm = options.start_mm;
  rig.watchdog_s = options.watchdog_s;
  rig.watchdog_action = options.watchdog_action;
  if (wire == "tcp") {
    rig.tcp_port = 0;
  } else {
    rig.line = need(drive::parse_endpoint("rtu:" + (folder_.path() / "drive").string() +
                                          "?baud=" + std::to_string(options.baud)));
  }
  rig_ = need(VirtualRig::start(rig));
  const std::string tcp = "tcp:127.0.0.1:" + std::to_string(rig_->tcp_port());
  const auto endpoint = rig.line ? *rig.line : need(drive::parse_endpoint(tcp));
  drive_ = std::make_unique<drive::Drive>(
      rig.profile, std::make_shared<drive::Link>(endpoint, timing_of(rig.profile)));
}

void BenchRig::make_ready() {
  const auto found = need(drive_->connect());
  if (found.unsafe) throw std::runtime_error(found.unsafe->message);
  need(drive_->poll());
  if (const Status enabled = drive_->enable(); !enabled) {
    throw std::runtime_error(enabled.error().message);
  }
}

void BenchRig::act(const std::string& line) {
  if (const std::string reply = rig_->reply_to(line); reply != "ok") {
    throw std::runtime_error(reply);
  }
}

double BenchRig::truth(const std::string& key) {
  const auto value = nlohmann::json::parse(rig_->reply_to("state")).at(key);
  return value.is_boolean() ? static_cast<double>(value.get<bool>()) : value.get<double>();
}

std::string BenchRig::mode() {
  return nlohmann::json::parse(rig_->reply_to("state")).at("mode").get<std::string>();
}

drive::DriveState BenchRig::poll_until(const std::function<bool(const drive::DriveState&)>& done) {
  const auto end = Clock::now() + kPatience;
  for (;;) {
    const auto state = need(drive_->poll());
    if (done(state)) return state;
    if (Clock::now() > end) throw std::runtime_error("the condition did not become true");
    std::this_thread::sleep_for(kPollEvery);
  }
}

BenchRig::~BenchRig() = default;

std::unique_ptr<drive::Link> BenchRig::other_link(const drive::LinkTiming& timing) const {
  return std::make_unique<drive::Link>(endpoint(), timing);
}

}  // namespace hydroprint::simulated_drive
