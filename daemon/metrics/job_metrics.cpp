#include "daemon/metrics/job_metrics.h"

#include <prometheus/counter.h>
#include <prometheus/histogram.h>
#include <prometheus/summary.h>
#include <prometheus/text_serializer.h>

#include <algorithm>

namespace hydroprint::daemon {
namespace {

constexpr int kMeterBatch = 1000;
constexpr std::chrono::milliseconds kPollInterval{500};
constexpr int kMostStages = 300;  // limited because workers choose the names of stages

std::string stage_of(const JobEvent& event) {
  if (event.state == JobState::kRunning) {
    return event.progress.phase.empty() ? "starting" : event.progress.phase;
  }
  return name_of(event.state);
}

double seconds_between(std::int64_t begin_ms, std::int64_t end_ms) {
  return static_cast<double>(std::max<std::int64_t>(end_ms - begin_ms, 0)) / 1000;
}

prometheus::Histogram::BucketBoundaries buckets_s() {
  return {0.1, 0.5, 1, 2, 5, 10, 30, 60, 120, 300, 600, 1800, 3600, 7200, 14400};
}

}  // namespace

JobMetrics::JobMetrics(JobStore& jobs)
    : jobs_(jobs),
      stages_(prometheus::BuildSummary()
                  .Name("hydroprint_job_stage_seconds")
                  .Help("Time that jobs spent in each stage since the daemon started.")
                  .Register(registry_)),
      finished_(prometheus::BuildCounter()
                    .Name("hydroprint_jobs_finished_total")
                    .Help("Finished jobs by outcome.")
                    .Register(registry_)),
      queue_waits_(prometheus::BuildHistogram()
                       .Name("hydroprint_job_queue_wait_seconds")
                       .Help("Time that jobs waited in the queue until they started.")
                       .Register(registry_)),
      durations_(prometheus::BuildHistogram()
                     .Name("hydroprint_job_duration_seconds")
                     .Help("Time from the start of jobs to their end, by outcome.")
                     .Register(registry_)),
      thread_([this, seq = jobs.last_seq().value_or(0)] { run(seq); }) {}

JobMetrics::~JobMetrics() {
  end_ = true;
  jobs_.notifier().ring();
  thread_.join();
}

void JobMetrics::run(std::int64_t seq) {
  while (!end_) {
    const std::uint64_t version = jobs_.notifier().count();
    const auto events = jobs_.all_events(seq, kMeterBatch);
    if (events) {
      for (const JobEvent& event : *events) take(event);
      if (!events->empty()) seq = events->back().seq;
      if (events->size() == kMeterBatch) continue;
    }
    jobs_.notifier().wait(version, kPollInterval);
  }
}

void JobMetrics::take(const JobEvent& event) {
  OpenJob& job = open_job(event);
  if (event.state == JobState::kRunning && !job.start_ms) start(job, event.time_ms);
  if (const std::string stage = stage_of(event); job.stage != stage) {
    observe_stage(job, event.time_ms);
    job.stage = stage;
    job.since_ms = event.time_ms;
  }
  // A computed job that is INTERRUPTED returns to the queue.
  const bool goes_on = event.state == JobState::kInterrupted && job.computed;
  if (!is_finished(event.state) || goes_on) return;
  finish(job, event);
  open_.erase(event.job);
}

JobMetrics::OpenJob& JobMetrics::open_job(const JobEvent& event) {
  if (const auto known = open_.find(event.job); known != open_.end()) return known->second;
  const auto job = jobs_.get(event.job);
  const OpenJob open{job ? job->definition.work.verb : "deleted", stage_of(event), event.time_ms,
                     !job || job->definition.traits.computed};
  return open_.emplace(event.job, open).first->second;
}

void JobMetrics::start(OpenJob& job, std::int64_t time_ms) {
  job.start_ms = time_ms;
  if (job.stage != name_of(JobState::kQueued)) return;
  queue_waits_.Add({{"kind", job.kind}}, buckets_s())
      .Observe(seconds_between(job.since_ms, time_ms));
}

void JobMetrics::finish(const OpenJob& job, const JobEvent& event) {
  const prometheus::Labels labels{{"kind", job.kind}, {"outcome", name_of(event.state)}};
  finished_.Add(labels).Increment();
  if (!job.start_ms) return;
  durations_.Add(labels, buckets_s()).Observe(seconds_between(*job.start_ms, event.time_ms));
}

void JobMetrics::observe_stage(const OpenJob& job, std::int64_t end_ms) {
  prometheus::Labels labels{{"kind", job.kind}, {"stage", job.stage}};
  if (!stages_.Has(labels) && ++stage_count_ > kMostStages) labels["stage"] = "other";
  stages_.Add(labels, prometheus::Summary::Quantiles{})
      .Observe(seconds_between(job.since_ms, end_ms));
}

std::string JobMetrics::text() const {
  return prometheus::TextSerializer().Serialize(registry_.Collect());
}

}  // namespace hydroprint::daemon
