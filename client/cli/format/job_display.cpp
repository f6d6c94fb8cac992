#include "client/cli/format/job_display.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace hydroprint::cli {
namespace {

int percent(double fraction) { return static_cast<int>(100 * fraction); }

// Returns ", 0:12 left", or an empty string.
std::string time_left(const std::optional<client::Time>& end) {
  if (!end) return "";
  using namespace std::chrono;
  return ", " + format_duration(ceil<seconds>(*end - system_clock::now())) + " left";
}

}  // namespace

std::string message_of(const client::JobUpdate& update) {
  if (!update.event) return "";
  const std::string& message = update.event->message;
  if (!update.job || !update.job->dip_status) return message;
  const client::DipStatus& status = *update.job->dip_status;
  const bool is_shown = message == status.instruction ||
                        std::count(status.warnings.begin(), status.warnings.end(), message) > 0;
  return is_shown ? "" : message;
}

std::vector<std::string> new_warnings(const std::optional<client::DipStatus>& before,
                                      const client::DipStatus& now) {
  std::vector<std::string> news;
  for (const std::string& warning : now.warnings)
    if (!before || std::count(before->warnings.begin(), before->warnings.end(), warning) == 0)
      news.push_back(warning);
  return news;
}

JobDisplay::JobDisplay(std::string job, int descriptor) : job_(std::move(job)), line_(descriptor) {}

void JobDisplay::update(const client::JobUpdate& update) {
  const auto take = [this](const auto& source) {
    state_ = source.state;
    progress_fraction_ = source.progress_fraction;
    phase_ = source.phase;
    eta_time_ = source.eta_time;
  };
  if (update.event) take(*update.event);
  if (update.job) take(*update.job);
  if (client::is_finished(state_)) return;  // the caller reports the result
  if (update.job && client::is_finished(*update.job)) return;
  if (update.job && update.job->dip_status) take_dip(*update.job->dip_status);
  if (const std::string news = message_of(update); !news.empty()) say(job_ + ": " + news);
  show();
}

void JobDisplay::take_dip(const client::DipStatus& status) {
  for (const std::string& warning : new_warnings(dip_, status)) say(job_ + ": warning: " + warning);
  if (!dip_ || dip_->step != status.step)
    say(job_ + ": " + std::string(client::name_of(status.step)) + ": " + status.instruction);
  dip_ = status;
}

void JobDisplay::show() {
  if (line_.is_terminal()) return line_.show(job_, progress_fraction_, text());
  if (dip_) return;  // the steps were shown already
  const int tenth = percent(progress_fraction_) / 10;
  const std::string key =
      std::string(client::name_of(state_)) + "/" + phase_ + "/" + std::to_string(tenth);
  if (std::exchange(last_key_, key) == key) return;
  say(job_ + ": " + std::to_string(percent(progress_fraction_)) + "%  " + text());
}

std::string JobDisplay::text() const {
  if (dip_) return std::string(client::name_of(dip_->step)) + time_left(dip_->step_end_time);
  std::string text = state_ == client::JobState::kRunning && !phase_.empty()
                         ? phase_
                         : std::string(client::name_of(state_));
  return text + time_left(eta_time_);
}

}  // namespace hydroprint::cli
