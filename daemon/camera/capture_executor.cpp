#include "daemon/camera/capture_executor.h"

#include <fmt/format.h>
#include <poll.h>

#include <cmath>
#include <utility>

#include "daemon/platform/durable_file.h"
#include "daemon/platform/log.h"
#include "daemon/workers/worker_run.h"

namespace hydroprint::daemon {
namespace {

constexpr int kTick_ms = 50;
constexpr std::chrono::milliseconds kStoreAgainAfter{500};
// Time allowed for starting, for opening the camera and for writing the frames.
constexpr int kMargin_s = 60;
constexpr std::int64_t kLargestFile = 64 << 20;
constexpr double kDefaultSeconds = 2;

Launch plan(const CameraConfig& camera, const RunFolder& folder, double seconds) {
  Launch out;
  out.program = camera.program;
  out.inputs = folder.inputs();
  out.work = folder.work();
  out.arguments = {fmt::format("--seconds={:g}", seconds),
                   fmt::format("--patience-s={}", camera.patience_s),
                   "--out=" + folder.out().string(), "--json"};
  if (camera.device != "any") out.arguments.push_back("--device=" + camera.device);
  out.limits = {0, static_cast<std::int64_t>(10 * (seconds + kMargin_s)), kLargestFile};
  out.confined = false;  // needs the camera, and reads nothing else
  out.niceness = kCameraNiceness;
  return out;
}

void wait_for(const WorkerExecutor& executor) {
  std::vector<pollfd> fds;
  for (const int fd : executor.descriptors()) fds.push_back({fd, POLLIN, 0});
  ::poll(fds.data(), fds.size(), kTick_ms);
}

}  // namespace

Result<std::unique_ptr<CaptureExecutor>> CaptureExecutor::make(CaptureDependencies dependencies) {
  return std::unique_ptr<CaptureExecutor>(new CaptureExecutor(std::move(dependencies)));
}

CaptureExecutor::~CaptureExecutor() { stop(); }

Status CaptureExecutor::check_camera_and_rig() const {
  HP_RETURN_IF_ERROR(check_camera(dependencies_.camera));
  const rig::Controller* rig = dependencies_.gateway.controller();
  if (rig != nullptr && rig::in_motion(rig->snapshot().condition.state)) {
    return fail(Code::kAborted, "the axis is moving; wait until it is at rest, or stop it",
                ErrorReason::MOTION_IN_PROGRESS);
  }
  return {};
}

Result<Job> CaptureExecutor::check(const JobRequest& request) {
  HP_RETURN_IF_ERROR(check_camera_and_rig());
  Job job;
  job.definition = request.definition;
  return job;
}

Result<Job> CaptureExecutor::create(const JobRequest& request) {
  const v1::CaptureSpec& spec = request.job.capture();
  const double seconds = spec.has_seconds() ? spec.seconds() : kDefaultSeconds;
  const std::lock_guard lock(mutex_);
  if (end_)
    return fail(Code::kAborted, "the daemon is shutting down; try again after it has restarted",
                ErrorReason::SHUTTING_DOWN);
  HP_ASSIGN_OR_RETURN(auto earlier,
                      dependencies_.jobs.repeated(request.definition.owner, request.key));
  if (earlier) return std::move(*earlier);
  HP_RETURN_IF_ERROR(check_camera_and_rig());
  const RigPlace place = dependencies_.places.place();
  HP_RETURN_IF_ERROR(dependencies_.places.keep());
  HP_ASSIGN_OR_RETURN(Job job, dependencies_.jobs.create(request.definition, request.key));
  // The thread of the last capture is about to end, because the store allows only one capture at a
  // time.
  if (thread_.joinable()) thread_.join();
  if (const Status noted = dependencies_.calibrations.note_capture(job.id, place); !noted) {
    give_up(job, noted.error());
    return dependencies_.jobs.get(job.id);
  }
  cancelled_ = false;
  job_ = job.id;
  // Lends the camera before the request is answered, so that viewers see the job immediately.
  thread_ = std::thread(
      [this, job, seconds, camera = dependencies_.live.reserve(job.id)] { go(job, seconds); });
  return job;
}

Result<Job> CaptureExecutor::cancel(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  auto job = dependencies_.jobs.cancel(id);
  if (job && job_ == id) cancelled_ = true;
  return job;
}

void CaptureExecutor::go(const Job& job, double seconds) {
  if (const Status done = run(job, seconds); !done) give_up(job, done.error());
  job_ = 0;
}

Status CaptureExecutor::run(const Job& job, double seconds) {
  dependencies_.live.wait_until_free();
  const RunFolder folder = dependencies_.layout.run(job.id);
  HP_RETURN_IF_ERROR(make_folder(folder.work()));
  const Launch launch = plan(dependencies_.camera, folder, seconds);
  const std::chrono::seconds limit(static_cast<int>(std::ceil(seconds)) + kMargin_s +
                                   dependencies_.camera.patience_s);
  HP_ASSIGN_OR_RETURN(const auto run,
                      WorkerRun::start(job, {job.id, 1, processes_.name(), "", folder.root}, launch,
                                       {processes_, dependencies_.layout, {limit}, [] {}}));
  while (!run->step(of_job(processes_.poll({run->execution()}), job.id), dependencies_.jobs,
                    dependencies_.clock())) {
    if (left_) run->stop(StopReason::kShutdown);
    if (cancelled_) run->stop(StopReason::kCancel);
    wait_for(processes_);
  }
  const auto ended = dependencies_.jobs.get(job.id);
  if (ended && ended->state == JobState::kSucceeded) latest_ms_ = ended->end_ms;
  return {};
}

/// Ends a job whose capture could not be started.
void CaptureExecutor::give_up(const Job& job, const Error& error) {
  discard(dependencies_.layout.run(job.id).root);
  log(LogLevel::kError, "capture_not_started", {{"job", job.id}, {"message", error.message}});
  while (!left_) {
    const auto ended = dependencies_.jobs.give_up(job.id, {error, {}, {}});
    if (ended || ended.error().code == Code::kFailedPrecondition ||
        ended.error().code == Code::kNotFound) {
      return;
    }
    std::this_thread::sleep_for(kStoreAgainAfter);
  }
}

void CaptureExecutor::stop() {
  left_ = true;
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  if (thread_.joinable()) thread_.join();
}

}  // namespace hydroprint::daemon
