#include "hardware/rig/motion_log.h"

namespace hydroprint::rig {

std::uint64_t MotionLog::begin(Motion motion, TimePoint now, double position_mm) {
  MotionReport next;
  next.number = report_.number + 1;
  next.motion = motion;
  next.begun = next.ended = next.rested = now;
  next.begin_mm = next.end_mm = position_mm;
  next.first_sample = status_.samples.newest() + 1;
  next.last_sample = status_.samples.newest();
  report_ = next;
  open_ = true;
  status_.put(report_);
  return report_.number;
}

void MotionLog::end(MotionReport::Outcome outcome, Cause cause, int alarm_code) {
  report_.outcome = outcome;
  report_.cause = cause;
  report_.alarm_code = alarm_code;
  report_.ended = std::chrono::steady_clock::now();
  status_.put(report_);
}

void MotionLog::see(const Sample& sample, bool at_rest) {
  if (!open_) return;
  report_.last_sample = sample.number;
  report_.end_mm = sample.position_mm;
  if (report_.outcome != MotionReport::Outcome::kRunning && at_rest) {
    report_.at_rest = true;
    report_.rested = sample.time;
    open_ = false;
  }
  status_.put(report_);
}

}  // namespace hydroprint::rig
