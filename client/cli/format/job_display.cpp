#include "client/cli/format/job_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "client/dip.h"
#include "client/job.h"
#include "client/name_of.h"
#include "proto/warning_message.h"

namespace hydroprint::cli {
namespace {

int whole_percent(double fraction) { return static_cast<int>(100 * fraction); }

// Returns ", 0:12 left", or an empty string.
std::string time_left(const std::optional<client::Time>& end) {
  if (!end) return "";
  using namespace std::chrono;
  return fmt::format(", {} left", format_duration(ceil<seconds>(*end - system_clock::now())));
}

}  // namespace

std::string message_of(const v1::WatchJobResponse& update) {
  const std::string& message = update.event().message();
  const v1::DipStatus& status = update.job().dip_status();
  const auto& warnings = status.warnings();
  const bool is_shown =
      message == status.instruction() ||
      std::any_of(warnings.begin(), warnings.end(),
                  [&](const v1::Warning& warning) { return warning.message() == message; });
  return is_shown ? "" : message;
}

std::string phase_text(const std::string& phase, const std::string& waits_for) {
  return waits_for.empty() ? phase : "waiting: " + waits_for;
}

std::vector<std::string> new_warnings(const v1::DipStatus& before, const v1::DipStatus& now) {
  std::vector<std::string> known, news;
  for (const v1::Warning& warning : before.warnings())
    known.push_back(hydroprint::text_of(warning));
  for (const v1::Warning& warning : now.warnings()) {
    const std::string text = hydroprint::text_of(warning);
    if (std::find(known.begin(), known.end(), text) == known.end()) news.push_back(text);
  }
  return news;
}

JobDisplay::JobDisplay(std::string job, int descriptor) : job_(std::move(job)), line_(descriptor) {}

void JobDisplay::update(const v1::WatchJobResponse& update) {
  const auto take = [this](const auto& source) {
    state_ = source.state();
    progress_fraction_ = source.progress_fraction();
    phase_ = phase_text(source.phase(), source.waits_for());
    eta_time_ = client::time_of(source.eta_time());
  };
  if (update.has_event()) take(update.event());
  if (update.has_job()) take(update.job());
  if (client::is_finished(state_)) return;  // the caller reports the result
  if (update.has_job() && client::is_finished(update.job())) return;
  if (update.job().has_dip_status()) take_dip(update.job().dip_status());
  if (const std::string news = message_of(update); !news.empty()) say(job_ + ": " + news);
  show();
}

void JobDisplay::take_dip(const v1::DipStatus& status) {
  for (const std::string& warning : new_warnings(dip_.value_or(v1::DipStatus()), status))
    say(job_ + ": warning: " + warning);
  if (!dip_ || dip_->step() != status.step())
    say(fmt::format("{}: {}: {}", job_, client::name_of(status.step()),
                    client::instruction_of(status)));
  dip_ = status;
}

void JobDisplay::show() {
  if (line_.is_terminal()) return line_.show(job_, progress_fraction_, text());
  if (dip_) return;  // the steps were shown already
  const int tenth = whole_percent(progress_fraction_) / 10;
  const std::string key = fmt::format("{}/{}/{}", client::name_of(state_), phase_, tenth);
  if (std::exchange(last_key_, key) == key) return;
  say(fmt::format("{}: {}%  {}", job_, whole_percent(progress_fraction_), text()));
}

std::string JobDisplay::text() const {
  if (dip_)
    return client::name_of(dip_->step()) + time_left(client::time_of(dip_->step_end_time()));
  std::string text =
      state_ == v1::Job::RUNNING && !phase_.empty() ? phase_ : client::name_of(state_);
  return text + time_left(eta_time_);
}

}  // namespace hydroprint::cli
