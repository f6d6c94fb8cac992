#include "client/cli/rig_session/dip_guide.h"

#include <fmt/format.h>
#include <unistd.h>

#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "client/cli/format/job_display.h"
#include "client/cli/format/rig_display.h"
#include "client/cli/rig_session/jogger.h"
#include "client/cli/terminal/console.h"
#include "client/cli/terminal/terminal.h"
#include "client/dip.h"
#include "client/jobs.h"
#include "client/name_of.h"
#include "client/rig.h"
#include "client/time.h"

namespace hydroprint::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using client::Time;

constexpr double kJogSpeed_mm_per_s = 2;
constexpr auto kRigPollInterval = 200ms;
constexpr auto kRedrawEvery = 250ms;
constexpr char kJogKeys[] = "  hold Down/j or Up/k to jog, + and - change the speed";
constexpr char kConfirmKey[] = "  Enter when done; Ctrl-C aborts the dip";

// Watches the job on its own thread.
class WatchedJob {
 public:
  WatchedJob(const Program& program, v1::Job job)
      : daemon_(program.options(stop_.get_token())),
        job_(std::move(job)),
        watcher_([this] { watch(); }) {}
  ~WatchedJob() {
    stop_.request_stop();
    watcher_.join();
  }
  WatchedJob(const WatchedJob&) = delete;
  WatchedJob& operator=(const WatchedJob&) = delete;

  [[nodiscard]] v1::Job job() const {
    const std::lock_guard lock(mutex_);
    return job_;
  }
  /// Returns the messages received since the last call.
  [[nodiscard]] std::vector<std::string> take_messages() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
  }
  /// Returns the result of watching; nullopt while it continues.
  [[nodiscard]] std::optional<Result<v1::Job>> ended() const {
    const std::lock_guard lock(mutex_);
    return ended_;
  }

 private:
  void watch() {
    const std::string name = job().name();
    auto ended = client::watch_job(
        daemon_, name, [this](const v1::WatchJobResponse& update) { take(update); },
        [this](const Error& error) { say("hydroprint: " + error.message + "; retrying"); });
    const std::lock_guard lock(mutex_);
    ended_ = std::move(ended);
  }

  void take(const v1::WatchJobResponse& update) {
    if (std::string news = message_of(update); !news.empty()) say(std::move(news));
    if (!update.has_job()) return;
    const std::lock_guard lock(mutex_);
    job_ = update.job();
  }

  void say(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
  }

  std::stop_source stop_;
  client::Connection daemon_;
  mutable std::mutex mutex_;
  v1::Job job_;
  std::vector<std::string> messages_;
  std::optional<Result<v1::Job>> ended_;
  std::thread watcher_;  // last member: it uses all the others
};

double to_seconds(auto time) { return std::chrono::duration<double>(time).count(); }

bool waits(const v1::Job& job) {
  return job.state() == v1::Job::WAITING_FOR_OPERATOR &&
         client::waits_for_operator(job.dip_status().step());
}

class Guide {
 public:
  Guide(Program& program, const HeldLease& lease, v1::Job job, StopAlarm& alarm)
      : program_(program),
        daemon_(program.daemon()),
        lease_(lease),
        watched_(program, std::move(job)),
        alarm_(alarm),
        line_(STDERR_FILENO) {}

  Result<v1::Job> run() {
    for (;;) {
      if (const auto ended = watched_.ended()) return *ended;
      if (program_.is_interrupted()) return fail(Code::kCancelled, "interrupted");
      if (keyboard_.gone())
        return fail(Code::kCancelled,
                    "the terminal was closed; " + watched_.job().name() + " continues");
      show(watched_.job());
      take_keys(keyboard_.read(30ms));
      jog();
      look_at_rig();
    }
  }

 private:
  void show(const v1::Job& job) {
    for (const std::string& message : watched_.take_messages()) line_.say(message);
    if (!job.has_dip_status()) return;
    const v1::DipStatus& status = job.dip_status();
    for (const std::string& warning : new_warnings(shown_.value_or(v1::DipStatus()), status))
      line_.say("  WARNING: " + warning);
    if (!shown_ || shown_->step() != status.step()) begin(status);
    shown_ = status;
    show_clock(job);
  }

  // At a new step, pending keys are discarded, because they were not meant for it.
  void begin(const v1::DipStatus& status) {
    Keyboard::forget();
    begun_ = std::chrono::system_clock::now();
    drawn_ = {};
    line_.say("");
    line_.say(client::name_of(status.step()) + ": " + client::instruction_of(status));
    jogger_.reset();
    if (status.step() == v1::DipStatus::FIND_CONTACT) {
      line_.say(kJogKeys);
      jogger_.emplace(daemon_, lease_.id(), kJogSpeed_mm_per_s);
    }
    if (client::waits_for_operator(status.step())) line_.say(kConfirmKey);
  }

  void show_clock(const v1::Job& job) {
    if (Clock::now() - drawn_ < kRedrawEvery) return;
    drawn_ = Clock::now();
    const v1::DipStatus& status = job.dip_status();
    const std::string name = client::name_of(status.step());
    const Time now = std::chrono::system_clock::now();
    std::string text;
    if (jogger_ || !waits(job)) text = place();
    if (jogger_) text += "  " + jogger_->text();
    if (const auto end = client::time_of(status.activation_end_time()))
      text += "  " + film_age(*end - now);
    const auto step_end = client::time_of(status.step_end_time());
    if (!step_end) return line_.show(name, job.progress_fraction(), text);
    const auto left = *step_end - now;
    const double whole_s = to_seconds(*step_end - begun_);
    text = fmt::format("{} left  {}",
                       format_duration(std::chrono::ceil<std::chrono::seconds>(left)), text);
    line_.show(name, whole_s > 0 ? 1 - to_seconds(left) / whole_s : 1, text);
  }

  static std::string film_age(Time::duration left) {
    const auto time = std::chrono::ceil<std::chrono::seconds>(left);
    if (time.count() <= 0) return "FILM TOO OLD since " + format_duration(-time);
    return "film good for " + format_duration(time);
  }

  std::string place() const {
    if (!rig_.has_position_mm()) return client::name_of(rig_.state());
    return fmt::format("at {:.2f} mm", rig_.position_mm());
  }

  void take_keys(const std::vector<Key>& keys) {
    for (const Key key : keys) {
      if (key == Key::kEnter) confirm();
      if (jogger_) jogger_->press(key, Clock::now());
    }
  }

  void confirm() {
    const v1::Job job = watched_.job();
    if (!waits(job) || !shown_ || shown_->step() != job.dip_status().step()) return;
    // Contact is recorded at standstill, so the key must be released first.
    if (jogger_ && jogger_->is_held()) return;
    // The stream reports the next step immediately; this response may be older.
    const auto next =
        client::confirm_step(daemon_, job.name(), job.dip_status().step(), lease_.id());
    if (!next) line_.say("  REFUSED: " + in_our_words(next.error()).message);
  }

  void jog() {
    if (!jogger_) return;
    auto answer = jogger_->tick(Clock::now());
    if (!answer && answer.error().code != Code::kCancelled)
      line_.say("  REFUSED: " + in_our_words(answer.error()).message);
    if (!answer) jogger_->press(Key::kOther, Clock::now());
    if (answer && *answer) see(std::move(**answer));
  }

  void look_at_rig() {
    if (Clock::now() - looked_ < kRigPollInterval || (jogger_ && jogger_->is_held())) return;
    looked_ = Clock::now();
    if (auto rig = client::get_rig(daemon_)) see(std::move(*rig));
  }

  void see(v1::Rig rig) {
    rig_ = std::move(rig);
    alarm_.look(rig_);
  }

  const Program& program_;
  client::Connection& daemon_;
  const HeldLease& lease_;
  WatchedJob watched_;
  StopAlarm& alarm_;
  ProgressLine line_;
  Keyboard keyboard_;
  std::optional<v1::DipStatus> shown_;
  Time begun_;  // when the current step was first shown
  std::optional<Jogger> jogger_;
  v1::Rig rig_;
  Clock::time_point looked_;
  // When the live line was drawn; other lines and a new step are shown immediately.
  Clock::time_point drawn_;
};

}  // namespace

Result<v1::Job> guide(Program& program, const HeldLease& lease, v1::Job job, StopAlarm& alarm) {
  return Guide(program, lease, std::move(job), alarm).run();
}

}  // namespace hydroprint::cli
