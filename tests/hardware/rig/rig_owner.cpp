// Owns a rig as the daemon does, and moves its axis down until this program is killed. Usage:
// rig_owner ENDPOINT PROFILE
#include <iostream>
#include <thread>

#include "hardware/rig/controller.h"

namespace hydroprint::rig {
namespace {

bool wait_for(const Controller& controller, State wanted) {
  for (int i = 0; i < 2000; ++i) {
    if (controller.snapshot().condition.state == wanted) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

int fail_with(const std::string& what) {
  std::cerr << "rig_owner: " << what << "\n";
  return 4;
}

int drive_down(const char* endpoint_text, const char* profile_path) {
  const auto endpoint = drive::parse_endpoint(endpoint_text);
  const auto profile = drive::read_drive_profile(profile_path);
  if (!endpoint || !profile) return fail_with("endpoint or profile");
  const auto controller = Controller::make({}, *profile, *endpoint);
  if (!controller) return fail_with(controller.error().message);
  Controller& rig = **controller;
  if (!wait_for(rig, State::kDisarmed)) return fail_with("no drive");
  if (const auto done = rig.arm().get(); !done) return fail_with(done.error().message);
  if (const auto done = rig.home().get(); !done) return fail_with(done.error().message);
  if (!wait_for(rig, State::kIdle)) return fail_with("not homed");
  if (const auto done = rig.dip({{250, 10, 0}}).get(); !done)
    return fail_with(done.error().message);
  std::this_thread::sleep_for(std::chrono::seconds(60));
  return 0;
}

}  // namespace
}  // namespace hydroprint::rig

int main(int argc, char** argv) {
  return argc == 3 ? hydroprint::rig::drive_down(argv[1], argv[2]) : 2;
}
