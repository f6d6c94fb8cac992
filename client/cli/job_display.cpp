#include "client/cli/job_display.h"

#include <unistd.h>

#include <chrono>
#include <utility>

namespace hydroprint::cli {
namespace {

int percent(double fraction) { return static_cast<int>(100 * fraction); }

}  // namespace

JobDisplay::JobDisplay(std::string job, int descriptor)
    : job_(std::move(job)), descriptor_(descriptor), line_(descriptor) {}

void JobDisplay::update(const client::JobUpdate& update) {
  const auto take = [this](const auto& source) {
    state_ = source.state;
    progress_fraction_ = source.progress_fraction;
    phase_ = source.phase;
    eta_time_ = source.eta_time;
  };
  if (update.event) take(*update.event);
  if (update.job) take(*update.job);
  if (client::is_finished(state_)) return;  // how it ended is for whoever waits to say
  if (update.event && !update.event->message.empty()) say(job_ + ": " + update.event->message);
  show();
}

void JobDisplay::say(const std::string& text) {
  line_.clear();
  const std::string line = printable(text) + "\n";
  [[maybe_unused]] const auto written = ::write(descriptor_, line.data(), line.size());
}

void JobDisplay::show() {
  if (line_.is_terminal()) return line_.show(job_, progress_fraction_, text());
  const int tenth = percent(progress_fraction_) / 10;
  const std::string key =
      std::string(client::name_of(state_)) + "/" + phase_ + "/" + std::to_string(tenth);
  if (std::exchange(last_key_, key) == key) return;
  say(job_ + ": " + std::to_string(percent(progress_fraction_)) + "%  " + text());
}

std::string JobDisplay::text() const {
  std::string text = state_ == client::JobState::kRunning && !phase_.empty()
                         ? phase_
                         : std::string(client::name_of(state_));
  if (eta_time_) {
    using namespace std::chrono;
    const auto left = ceil<seconds>(*eta_time_ - system_clock::now());
    text += ", " + format_duration(left) + " left";
  }
  return text;
}

}  // namespace hydroprint::cli
