#include "hardware/drive/stop_line.h"

#include <thread>

#include "hardware/drive/command_encoder.h"

namespace hydroprint::drive {
namespace {

constexpr std::chrono::milliseconds kPause{5};

Status send_stop(const DriveProfile& profile, Link& link) {
  HP_ASSIGN_OR_RETURN(const auto requests, requests_for(profile, Command::kStop, 0, 0));
  for (const Request& request : requests) {
    HP_RETURN_IF_ERROR(link.transact(request, Urgency::kStop));
  }
  return {};
}

}  // namespace

StopLine::StopLine(const Drive& drive)
    : profile_(drive.profile()), link_(stop_link(drive.link())) {}

Status StopLine::connect() {
  if (link_->is_open()) return {};
  return link_->connect();
}

Status StopLine::stop(std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  for (;;) {
    Status done = connect().and_then([this] { return send_stop(profile_, *link_); });
    if (done || std::chrono::steady_clock::now() + kPause >= end) return done;
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace hydroprint::drive
