#include "tests/hardware/simulator/drive/bench_rig.h"

#include <stdexcept>
#include <thread>

#include "tests/support/value_of.h"

namespace hydroprint::simulated_drive {
namespace {

using testing::value_of;

constexpr auto kPollEvery = milliseconds(20);
constexpr double kPatience_s = 5;

testing::VirtualRigOptions with_wire(testing::VirtualRigOptions options, const std::string& wire) {
  options.wire = wire;
  return options;
}

drive::Drive client_of(const drive::DriveProfile& profile, const std::string& address) {
  const drive::LinkTiming timing{milliseconds(500), profile.response_timeout, profile.worst_delay,
                                 profile.bus};
  return {profile, std::make_shared<drive::Link>(value_of(drive::parse_endpoint(address)), timing)};
}

}  // namespace

BenchRig::BenchRig(const std::string& wire, const testing::VirtualRigOptions& options)
    : testing::VirtualRig(with_wire(options, wire)),
      drive_(client_of(value_of(drive::read_drive_profile(options.profile)), address())) {}

void BenchRig::make_ready() {
  const auto found = value_of(drive_.connect());
  if (found.unsafe) throw std::runtime_error(found.unsafe->message);
  value_of(drive_.poll());
  if (const Status enabled = drive_.enable(); !enabled) {
    throw std::runtime_error(enabled.error().message);
  }
}

drive::DriveState BenchRig::poll_until(const std::function<bool(const drive::DriveState&)>& done) {
  const auto start = Clock::now();
  for (;;) {
    const auto state = value_of(drive_.poll());
    if (done(state)) return state;
    if (testing::seconds_since(start) > kPatience_s) {
      throw std::runtime_error("the drive did not reach the expected state within 5 s");
    }
    std::this_thread::sleep_for(kPollEvery);
  }
}

std::unique_ptr<drive::Link> BenchRig::other_link(const drive::LinkTiming& timing) const {
  return std::make_unique<drive::Link>(endpoint(), timing);
}

}  // namespace hydroprint::simulated_drive
