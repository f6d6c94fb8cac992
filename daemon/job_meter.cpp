#include "daemon/job_meter.h"

#include <algorithm>

namespace hydroprint::daemon {
namespace {

constexpr int kMeterBatch = 1000;
constexpr std::chrono::milliseconds kMeterNap{500};
constexpr std::size_t kMostStages = 300;  // a worker says what its stages are called

std::string stage_of(const JobEvent& event) {
  if (event.state == JobState::kRunning) {
    return event.progress.phase.empty() ? "starting" : event.progress.phase;
  }
  return name_of(event.state);
}

}  // namespace

JobMeter::JobMeter(JobStore& jobs) : jobs_(jobs), thread_([this] { run(); }) {}

JobMeter::~JobMeter() {
  end_ = true;
  jobs_.bell().ring();
  thread_.join();
}

void JobMeter::run() {
  std::int64_t seq = jobs_.last_seq().value_or(0);
  while (!end_) {
    const std::uint64_t rings = jobs_.bell().count();
    const auto events = jobs_.all_events(seq, kMeterBatch);
    if (events) {
      for (const JobEvent& event : *events) take(event);
      if (!events->empty()) seq = events->back().seq;
      if (events->size() == kMeterBatch) continue;
    }
    jobs_.bell().wait(rings, kMeterNap);
  }
}

void JobMeter::take(const JobEvent& event) {
  std::string kind;
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = open_.find(event.job); known != open_.end()) kind = known->second.kind;
  }
  if (kind.empty()) {
    const auto job = jobs_.get(event.job);
    kind = job ? job->made.work.verb : "deleted";
  }
  const std::lock_guard lock(mutex_);
  const std::string stage = stage_of(event);
  auto& seen = open_.try_emplace(event.job, Seen{kind, stage, event.time_ms}).first->second;
  if (seen.stage != stage) {
    spend(seen, event.time_ms);
    seen = {kind, stage, event.time_ms};
  }
  // A computation that is INTERRUPTED is queued again.
  const bool goes_on = event.state == JobState::kInterrupted && is_computed(kind);
  if (!is_finished(event.state) || goes_on) return;
  ++ended_[{kind, name_of(event.state)}];
  if (captures(kind) && event.state == JobState::kSucceeded) camera_ms_ = event.time_ms;
  open_.erase(event.job);
}

void JobMeter::spend(const Seen& seen, std::int64_t until_ms) {
  std::pair key(seen.kind, seen.stage);
  if (spent_.size() >= kMostStages && !spent_.contains(key)) key.second = "other";
  Spent& spent = spent_[key];
  spent.sum_s += static_cast<double>(std::max<std::int64_t>(until_ms - seen.since_ms, 0)) / 1000;
  ++spent.count;
}

void JobMeter::describe(Exposition& out) const {
  const std::lock_guard lock(mutex_);
  out.begin("hydroprint_job_stage_seconds", "summary",
            "Time that jobs spent in a stage, since the daemon started.");
  for (const auto& [key, spent] : spent_) {
    out.sample(spent.sum_s, {{"kind", key.first}, {"stage", key.second}}, "_sum");
    out.sample(static_cast<double>(spent.count), {{"kind", key.first}, {"stage", key.second}},
               "_count");
  }
  out.begin("hydroprint_jobs_finished_total", "counter", "Jobs that ended, by how they did.");
  for (const auto& [key, count] : ended_) {
    out.sample(static_cast<double>(count), {{"kind", key.first}, {"outcome", key.second}});
  }
}

std::int64_t JobMeter::camera_ms() const {
  const std::lock_guard lock(mutex_);
  return camera_ms_;
}

}  // namespace hydroprint::daemon
