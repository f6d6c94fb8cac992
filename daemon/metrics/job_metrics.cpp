#include "daemon/metrics/job_metrics.h"

#include <algorithm>

namespace hydroprint::daemon {
namespace {

constexpr int kMeterBatch = 1000;
constexpr std::chrono::milliseconds kMeterNap{500};
constexpr std::size_t kMostStages = 300;  // workers choose the names of their stages

std::string stage_of(const JobEvent& event) {
  if (event.state == JobState::kRunning) {
    return event.progress.phase.empty() ? "starting" : event.progress.phase;
  }
  return name_of(event.state);
}

}  // namespace

JobMetrics::JobMetrics(JobStore& jobs) : jobs_(jobs), thread_([this] { run(); }) {}

JobMetrics::~JobMetrics() {
  end_ = true;
  jobs_.notifier().ring();
  thread_.join();
}

void JobMetrics::run() {
  std::int64_t seq = jobs_.last_seq().value_or(0);
  while (!end_) {
    const std::uint64_t rings = jobs_.notifier().count();
    const auto events = jobs_.all_events(seq, kMeterBatch);
    if (events) {
      for (const JobEvent& event : *events) take(event);
      if (!events->empty()) seq = events->back().seq;
      if (events->size() == kMeterBatch) continue;
    }
    jobs_.notifier().wait(rings, kMeterNap);
  }
}

void JobMetrics::take(const JobEvent& event) {
  Seen seen = seen_of(event);
  const std::lock_guard lock(mutex_);
  if (const std::string stage = stage_of(event); seen.stage != stage) {
    spend(seen, event.time_ms);
    seen.stage = stage;
    seen.since_ms = event.time_ms;
  }
  open_[event.job] = seen;
  // A computed job that is INTERRUPTED returns to the queue.
  const bool goes_on = event.state == JobState::kInterrupted && seen.computed;
  if (!is_finished(event.state) || goes_on) return;
  ++ended_[{seen.kind, name_of(event.state)}];
  open_.erase(event.job);
}

JobMetrics::Seen JobMetrics::seen_of(const JobEvent& event) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = open_.find(event.job); known != open_.end()) return known->second;
  }
  const auto job = jobs_.get(event.job);
  return {job ? job->made.work.verb : "deleted", stage_of(event), event.time_ms,
          !job || job->made.traits.computed};
}

void JobMetrics::spend(const Seen& seen, std::int64_t until_ms) {
  std::pair key(seen.kind, seen.stage);
  if (spent_.size() >= kMostStages && !spent_.contains(key)) key.second = "other";
  Spent& spent = spent_[key];
  spent.sum_s += static_cast<double>(std::max<std::int64_t>(until_ms - seen.since_ms, 0)) / 1000;
  ++spent.count;
}

void JobMetrics::describe(PrometheusText& out) const {
  const std::lock_guard lock(mutex_);
  out.begin("hydroprint_job_stage_seconds", "summary",
            "Time that jobs spent in each stage since the daemon started.");
  for (const auto& [key, spent] : spent_) {
    out.sample(spent.sum_s, {{"kind", key.first}, {"stage", key.second}}, "_sum");
    out.sample(static_cast<double>(spent.count), {{"kind", key.first}, {"stage", key.second}},
               "_count");
  }
  out.begin("hydroprint_jobs_finished_total", "counter", "Finished jobs by outcome.");
  for (const auto& [key, count] : ended_) {
    out.sample(static_cast<double>(count), {{"kind", key.first}, {"outcome", key.second}});
  }
}

}  // namespace hydroprint::daemon
