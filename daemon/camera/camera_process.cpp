#include "daemon/camera/camera_process.h"

#include <fmt/format.h>
#include <signal.h>

#include <utility>

#include "daemon/platform/durable_file.h"
#include "daemon/store/artifact_files.h"
#include "daemon/workers/worker_outcome.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kLargestPicture = 4 << 20;
constexpr std::size_t kReadAtOnce = 1 << 20;
constexpr std::size_t kWordsHeld = 16 << 10;
constexpr std::chrono::seconds kTimeToEnd{2};
// Added to the program's own timeout for the camera, so that the program can report its more
// precise error first.
constexpr std::chrono::seconds kStartupMargin{10};
constexpr std::int64_t kDay_s = 24LL * 3600;

Launch launch_of(const CameraConfig& camera, const std::filesystem::path& folder) {
  Launch out;
  out.program = camera.program;
  out.inputs = folder / "in";
  out.work = folder / "work";
  out.arguments = {"--live", "--json", fmt::format("--patience-s={}", camera.patience_s)};
  if (camera.device != "any") out.arguments.push_back("--device=" + camera.device);
  out.limits = {0, kDay_s, kLargestPicture};
  out.confined = false;  // needs the camera, and reads nothing else
  out.niceness = kCameraNiceness;
  return out;
}

}  // namespace

CameraProcess::CameraProcess(std::filesystem::path folder, std::chrono::seconds patience)
    : folder_(std::move(folder)),
      patience_(patience),
      last_output_(std::chrono::steady_clock::now()) {}

Result<std::unique_ptr<CameraProcess>> CameraProcess::start(const CameraConfig& camera,
                                                            const Layout& layout) {
  std::unique_ptr<CameraProcess> process(new CameraProcess(
      layout.live_camera(), std::chrono::seconds(camera.patience_s) + kStartupMargin));
  const Launch launched = launch_of(camera, process->folder_);
  HP_RETURN_IF_ERROR(make_folder(launched.inputs));
  HP_RETURN_IF_ERROR(make_folder(launched.work));
  HP_ASSIGN_OR_RETURN(process->process_, launch(launched));
  return process;
}

CameraProcess::~CameraProcess() {
  if (process_.pid > 0 && !wait_status_) {
    signal_group(process_, SIGKILL);
    (void)wait_for_end(process_, kTimeToEnd);
  }
  discard(folder_);
}

std::vector<int> CameraProcess::descriptors() const {
  return {process_.handle.get(), is_readable_ ? process_.answer.get() : -1};
}

std::vector<FramedMessage> CameraProcess::read(Time now) {
  std::vector<FramedMessage> pictures;
  const std::size_t before = buffer_.size();
  if (!is_readable_) return pictures;
  is_readable_ = drain(process_.answer, buffer_, kReadAtOnce);
  if (buffer_.size() > before) last_output_ = now;
  for (;;) {
    auto picture = cut_framed(buffer_, kLargestPicture);
    // The last line contains the reason for the end instead of a picture.
    if (!picture) is_readable_ = false;
    if (!picture || !*picture) return pictures;
    pictures.push_back(std::move(**picture));
  }
}

void CameraProcess::ask_to_end(Time now) {
  if (kill_at_) return;
  kill_at_ = now + kTimeToEnd;
  signal_group(process_, SIGTERM);
}

bool CameraProcess::has_ended(Time now) {
  if (wait_status_) return true;
  timed_out_ = timed_out_ || (!kill_at_ && now >= last_output_ + patience_);
  if (timed_out_ || (kill_at_ && now >= *kill_at_)) signal_group(process_, SIGKILL);
  wait_status_ = wait_for_end(process_);
  if (!wait_status_) return false;
  (void)drain(process_.answer, buffer_, kReadAtOnce);
  (void)drain(process_.errors, words_, kWordsHeld);
  return true;
}

std::optional<Error> CameraProcess::failure() const {
  if (!wait_status_ || kill_at_) return {};
  if (timed_out_) {
    return Error{Code::kUnavailable,
                 "the camera does not respond; unplug it and plug it in again",
                 ErrorReason::CAMERA_STALLED,
                 {}};
  }
  auto why = judge(*wait_status_, StopReason::kNothing, words_, buffer_);
  if (!why) {
    return Error{Code::kUnavailable,
                 "the camera program ended unexpectedly; check that "
                 "camera.program is hydroprint-capture",
                 ErrorReason::WORKER_UNUSABLE,
                 {}};
  }
  Error& error = why->error;
  error.code = Code::kUnavailable;
  return std::move(error);
}

}  // namespace hydroprint::daemon
