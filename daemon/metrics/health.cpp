#include "daemon/metrics/health.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "daemon/platform/clock.h"
#include "daemon/rig/to_proto_rig.h"

namespace hydroprint::daemon {
namespace {

using prometheus::Registry;
using v1::Rig;

constexpr std::array kOpenStates{JobState::kQueued, JobState::kWaitingForOperator,
                                 JobState::kRunning, JobState::kCancelling};

// Returns the resident bytes of a process; 0 if /proc does not contain them.
double memory_of(const std::string& process) {
  std::ifstream file("/proc/" + process + "/statm");
  double pages = 0, resident = 0;
  file >> pages >> resident;
  return file ? resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) : 0;
}

double memory_of_children() {
  double bytes = 0;
  std::error_code ignored;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task", ignored)) {
    std::ifstream children(thread.path() / "children");
    for (std::string child; children >> child;) bytes += memory_of(child);
  }
  return bytes;
}

prometheus::Family<prometheus::Gauge>& add_gauges(const char* name, const char* help,
                                                  Registry& out) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(out);
}

void add_gauge(const char* name, const char* help, double value, Registry& out) {
  add_gauges(name, help, out).Add({}).Set(value);
}

void add_counter(const char* name, const char* help, std::uint64_t value, Registry& out) {
  prometheus::BuildCounter().Name(name).Help(help).Register(out).Add({}).Increment(
      static_cast<double>(value));
}

void describe_queue(const ServiceContext& backend, Registry& out) {
  auto& jobs = add_gauges("hydroprint_jobs", "Unfinished jobs by state.", out);
  double queued = 0;
  for (const JobState state : kOpenStates) {
    const auto ids = backend.jobs.ids_in_state(state);
    if (!ids) continue;
    const auto count = static_cast<double>(ids->size());
    if (state == JobState::kQueued) queued = count;
    jobs.Add({{"state", name_of(state)}}).Set(count);
  }
  add_gauge("hydroprint_queue_depth", "Jobs waiting for a worker.", queued, out);
  const auto pause = backend.queue.pause();
  if (pause) {
    add_gauge("hydroprint_queue_paused", "1 while the queue is paused.", pause->paused ? 1 : 0,
              out);
  }
  add_gauge("hydroprint_worker_slots", "Maximum number of concurrent workers.",
            backend.pool.slots(), out);
}

void describe_replies(const v1::LinkQuality& link, Registry& out) {
  add_counter("hydroprint_drive_damaged_replies_total",
              "Replies of the drive that were damaged or belonged to another request.",
              link.damaged_replies(), out);
  add_counter("hydroprint_drive_unanswered_requests_total",
              "Requests to the drive without a reply in time.", link.unanswered_requests(), out);
  add_counter("hydroprint_drive_retried_reads_total",
              "Reads that were repeated because their reply was damaged or missing.",
              link.retried_reads(), out);
  if (link.reply_times().empty()) return;
  prometheus::Histogram::BucketBoundaries limits_s;
  std::vector<double> replies;
  for (const auto& bucket : link.reply_times()) {
    if (bucket.has_at_most_s()) limits_s.push_back(bucket.at_most_s());
    replies.push_back(static_cast<double>(bucket.replies()));
  }
  prometheus::BuildHistogram()
      .Name("hydroprint_drive_reply_seconds")
      .Help("Time from sending a request to the end of the drive's reply.")
      .Register(out)
      .Add({}, limits_s)
      .ObserveMultiple(replies, link.reply_time_sum_s());
}

void describe_scheduling(const v1::LinkQuality& link, Registry& out) {
  using v1::LinkQuality;
  if (link.scheduling() == LinkQuality::SCHEDULING_UNSPECIFIED) return;
  auto& schedulings =
      add_gauges("hydroprint_rig_thread_scheduling",
                 "1 for the scheduling of the thread that polls the drive, 0 for others.", out);
  for (const auto each :
       {LinkQuality::REAL_TIME, LinkQuality::RAISED_PRIORITY, LinkQuality::NORMAL_PRIORITY}) {
    schedulings.Add({{"scheduling", LinkQuality::Scheduling_Name(each)}})
        .Set(link.scheduling() == each ? 1 : 0);
  }
  add_gauge("hydroprint_rig_memory_locked",
            "1 if the memory of the thread that polls the drive cannot be swapped out.",
            link.memory_locked() ? 1 : 0, out);
}

void describe_rig(const Rig& rig, Registry& out) {
  auto& states =
      add_gauges("hydroprint_rig_state", "1 for the rig's current state, 0 for others.", out);
  for (int state = Rig::State_MIN; state <= Rig::State_MAX; ++state) {
    if (state == Rig::STATE_UNSPECIFIED || !Rig::State_IsValid(state)) continue;
    states.Add({{"state", Rig::State_Name(static_cast<Rig::State>(state))}})
        .Set(rig.state() == state ? 1 : 0);
  }
  if (rig.has_position_mm()) {
    add_gauge("hydroprint_rig_position_mm", "Last known position of the axis.", rig.position_mm(),
              out);
  }
  const v1::LinkQuality& link = rig.link_quality();
  add_counter("hydroprint_drive_polls_total", "Polls of the drive.", link.polls(), out);
  add_counter("hydroprint_drive_missed_polls_total", "Polls without a valid answer.",
              link.missed_polls(), out);
  add_counter("hydroprint_drive_skipped_polls_total", "Poll periods that were skipped.",
              link.skipped_polls(), out);
  add_counter("hydroprint_drive_late_polls_total",
              "Polls that began more than half a polling period late.", link.late_polls(), out);
  add_counter("hydroprint_drive_connects_total", "Connections made to the drive.", link.connects(),
              out);
  add_gauge("hydroprint_drive_poll_lateness_max_seconds", "Largest delay of a poll.",
            link.largest_lateness_s(), out);
  add_gauge("hydroprint_drive_poll_lateness_rms_seconds", "Root mean square delay of polls.",
            link.rms_lateness_s(), out);
  describe_replies(link, out);
  describe_scheduling(link, out);
}

void describe_process(Registry& out) {
  if (const double bytes = memory_of("self"); bytes > 0) {
    add_gauge("process_resident_memory_bytes", "Resident memory of the daemon.", bytes, out);
    add_gauge("hydroprint_children_resident_memory_bytes",
              "Resident memory of workers and other child processes.", memory_of_children(), out);
  }
}

}  // namespace

HealthReport health_report(const ServiceContext& backend) {
  HealthReport report;
  const auto running = backend.jobs.ids_in_state(JobState::kRunning);
  const auto queued = backend.jobs.ids_in_state(JobState::kQueued);
  report.is_good = running && queued && !backend.stopping;
  const Rig rig = rig_message(backend.gateway);
  nlohmann::json json = {
      {"status", report.is_good ? "ok" : "bad"},
      {"version", HYDROPRINT_VERSION},
      {"store", running ? "ok" : running.error().message},
      {"rig", {{"state", Rig::State_Name(rig.state())}, {"trouble", rig.trouble()}}},
      {"camera", backend.camera.device.empty() ? "none" : "configured"},
      {"workers", {{"slots", backend.pool.slots()}, {"running", running ? running->size() : 0}}}};
  if (backend.stopping) json["status"] = "stopping";
  report.json = json.dump();
  return report;
}

std::string metrics_text(const ServiceContext& backend, const JobMetrics& meter,
                         const CertificateReloader* certificate) {
  Registry out;  // used once, so that metrics with unknown values are absent
  describe_queue(backend, out);
  describe_rig(rig_message(backend.gateway), out);
  if (const std::int64_t taken_ms =
          std::max(backend.captures.latest_ms(), backend.live.latest_ms());
      taken_ms != 0) {
    add_gauge("hydroprint_camera_frame_age_seconds",
              "Age of the camera's latest frame that was saved or shown.",
              static_cast<double>(system_clock_ms() - taken_ms) / 1000, out);
  }
  add_counter("hydroprint_rejected_logins_total", "Rejected sign-in attempts.",
              backend.accounts.sessions().failed_attempts(), out);
  if (certificate != nullptr) {
    add_gauge("hydroprint_tls_certificate_expiry_timestamp_seconds",
              "Expiry of the TLS certificate, Unix time in seconds.",
              static_cast<double>(certificate->current()->expire_s()), out);
  }
  describe_process(out);
  return prometheus::TextSerializer().Serialize(out.Collect()) + meter.text();
}

}  // namespace hydroprint::daemon
