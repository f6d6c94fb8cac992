#include "hardware/drive/late_replies.h"

#include <algorithm>

namespace hydroprint::drive {

void LateReplies::add(const Request& request, TimePoint until) {
  const auto now = std::chrono::steady_clock::now();
  std::erase_if(requests_, [&](const Missing& missing) {
    return missing.until < now || replies_look_alike(missing.request, request);
  });
  requests_.push_back({request, until});
}

void LateReplies::pass_over() {
  for (Missing& missing : requests_) missing.is_passed_over = true;
}

bool LateReplies::expects_any(TimePoint now) const {
  return std::any_of(requests_.begin(), requests_.end(), [&](const Missing& missing) {
    return !missing.is_passed_over && missing.until > now;
  });
}

LateReplies::TimePoint LateReplies::clear_for(const Request& request) const {
  TimePoint out{};
  for (const Missing& missing : requests_) {
    if (!missing.is_passed_over && replies_look_alike(missing.request, request))
      out = std::max(out, missing.until);
  }
  return out;
}

bool LateReplies::may_be_confused(const Request& request, TimePoint now) const {
  return std::any_of(requests_.begin(), requests_.end(), [&](const Missing& missing) {
    return missing.until > now && replies_look_alike(missing.request, request);
  });
}

}  // namespace hydroprint::drive
