#include "daemon/metrics/health.h"

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

void describe_queue(const ServiceContext& backend, PrometheusText& out) {
  out.begin("hydroprint_jobs", "gauge", "Unfinished jobs by state.");
  double queued = 0;
  for (const JobState state : kOpenStates) {
    const auto ids = backend.jobs.ids_in_state(state);
    if (!ids) continue;
    const auto count = static_cast<double>(ids->size());
    if (state == JobState::kQueued) queued = count;
    out.sample(count, {{"state", name_of(state)}});
  }
  out.single("hydroprint_queue_depth", "gauge", "Jobs waiting for a worker.", queued);
  const auto pause = backend.jobs.pause();
  if (pause) {
    out.single("hydroprint_queue_paused", "gauge", "1 while the queue is paused.",
               pause->paused ? 1 : 0);
  }
  out.single("hydroprint_worker_slots", "gauge", "Maximum number of concurrent workers.",
             backend.pool.slots());
}

void describe_rig(const Rig& rig, PrometheusText& out) {
  out.begin("hydroprint_rig_state", "gauge", "1 for the rig's current state, 0 for others.");
  for (int state = Rig::State_MIN; state <= Rig::State_MAX; ++state) {
    if (state == Rig::STATE_UNSPECIFIED || !Rig::State_IsValid(state)) continue;
    out.sample(rig.state() == state ? 1 : 0,
               {{"state", Rig::State_Name(static_cast<Rig::State>(state))}});
  }
  if (rig.has_position_mm()) {
    out.single("hydroprint_rig_position_mm", "gauge", "Last known position of the axis.",
               rig.position_mm());
  }
  const v1::LinkQuality& link = rig.link_quality();
  const auto count = [&](const char* name, const char* help, std::uint64_t value) {
    out.single(name, "counter", help, static_cast<double>(value));
  };
  count("hydroprint_drive_polls_total", "Polls of the drive.", link.polls());
  count("hydroprint_drive_missed_polls_total", "Polls without a valid answer.",
        link.missed_polls());
  count("hydroprint_drive_skipped_polls_total", "Poll periods that were skipped.",
        link.skipped_polls());
  count("hydroprint_drive_connects_total", "Connections made to the drive.", link.connects());
  out.single("hydroprint_drive_poll_lateness_max_seconds", "gauge", "Largest delay of a poll.",
             link.largest_lateness_s());
  out.single("hydroprint_drive_poll_lateness_rms_seconds", "gauge",
             "Root mean square delay of polls.", link.rms_lateness_s());
}

void describe_process(PrometheusText& out) {
  if (const double bytes = memory_of("self"); bytes > 0) {
    out.single("process_resident_memory_bytes", "gauge", "Resident memory of the daemon.", bytes);
    out.single("hydroprint_children_resident_memory_bytes", "gauge",
               "Resident memory of workers and other child processes.", memory_of_children());
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
  PrometheusText out;
  describe_queue(backend, out);
  meter.describe(out);
  describe_rig(rig_message(backend.gateway), out);
  if (const std::int64_t taken_ms =
          std::max(backend.captures.latest_ms(), backend.live.latest_ms());
      taken_ms != 0) {
    out.single("hydroprint_camera_frame_age_seconds", "gauge",
               "Age of the camera's latest frame that was saved or shown.",
               static_cast<double>(system_clock_ms() - taken_ms) / 1000);
  }
  out.single("hydroprint_rejected_logins_total", "counter", "Rejected sign-in attempts.",
             static_cast<double>(backend.accounts.failed_attempts()));
  if (certificate != nullptr) certificate->describe(out);
  describe_process(out);
  return out.text();
}

}  // namespace hydroprint::daemon
