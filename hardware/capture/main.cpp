// hydroprint-capture captures frames of a depth camera in its own process, so that a driver that
// hangs or crashes does not affect other processes.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "hardware/capture/frames.h"
#include "hardware/capture/live.h"
#include "hardware/capture/options.h"
#include "hardware/capture/watchdog.h"
#include "hardware/capture/write_frames.h"
#include "hardware/depth_camera/depth_camera.h"
#include "sim/base/process/error_output.h"
#include "sim/base/process/out_folder.h"
#include "sim/base/process/progress.h"
#include "sim/base/process/progress_sinks.h"
#include "sim/base/process/quiet_stderr.h"
#include "sim/base/process/termination.h"

namespace hydroprint::capture {
namespace {

constexpr const char* kProgram = "hydroprint-capture";
constexpr int kNiceness = 10;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void print_error(const Error& error, bool json) {
  if (json) worker::print_failure(error, exit_status(error));
  worker::print_error(kProgram, full_message(error));
}

/// A recording in progress, under a temporary name until it is complete.
class Recording {
 public:
  explicit Recording(std::filesystem::path path) : path_(std::move(path)) {
    if (path_.empty()) return;
    path_ = std::filesystem::absolute(path_);
    partial_ =
        path_.parent_path() / fmt::format(".part-{}-{}", ::getpid(), path_.filename().string());
  }
  ~Recording() { abandon(); }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] Status start(depth_camera::DepthCamera& camera) const {
    return partial_.empty() ? Status{} : camera.record(partial_);
  }
  [[nodiscard]] Status finish(depth_camera::DepthCamera& camera) {
    camera.finish_recording();
    if (partial_.empty()) return {};
    std::error_code error;
    std::filesystem::rename(partial_, path_, error);
    if (!error) return {};
    return fail(Code::kPermissionDenied,
                path_.string() + ": cannot be written. Choose another file");
  }
  void abandon() const {
    std::error_code ignored;
    if (!partial_.empty()) std::filesystem::remove(partial_, ignored);
  }

 private:
  std::filesystem::path path_, partial_;
};

Result<std::unique_ptr<depth_camera::DepthCamera>> open(const Options& options) {
  if (!options.recording.empty())
    return depth_camera::DepthCamera::open_recording(options.recording);
  return depth_camera::DepthCamera::open_device(options.device);
}

struct Summary {
  std::filesystem::path dir;
  std::size_t frames = 0;
  int lost = 0;
};

/// Returns a function that cleans up and ends the process if the driver hangs.
std::function<void()> bite(const Options& options, const worker::QuietStderr& quiet,
                           std::function<void()> clean_up) {
  return [&options, &quiet, clean_up = std::move(clean_up)] {
    clean_up();
    quiet.restore();
    const std::string name = !options.recording.empty() ? options.recording.string()
                             : options.device.empty()   ? "the camera"
                                                        : options.device;
    const Error error{
        Code::kUnavailable,
        name + ": the driver does not respond. Unplug the camera and plug it in again",
        ErrorReason::CAMERA_STALLED,
        {}};
    print_error(error, options.json);
    ::_exit(static_cast<int>(exit_status(error)));
  };
}

Result<Summary> run(const Options& options, worker::Termination& termination,
                    const worker::QuietStderr& quiet) {
  HP_ASSIGN_OR_RETURN(worker::OutFolder folder, worker::OutFolder::plan(options.out));
  Recording recording(options.record);
  const auto clean_up = [&] {
    folder.abandon();
    recording.abandon();
  };
  const worker::CleanupAtTermination cleanup(termination, clean_up);
  worker::ProgressPipe pipe(options.progress_fd);
  const worker::ProgressLine line(quiet.own());
  worker::Progress progress({{"capture", 0.7}, {"writing", 0.3}}, seconds_now,
                            [&](const worker::ProgressReport& report) {
                              pipe.write(report);
                              line.show(report);
                            });
  const Context context{
      1, [&](std::string_view stage, double fraction) { progress.update(stage, fraction); },
      [&termination] { return termination.requested(); }};
  // The watchdog waits longer than the camera's own timeout, because that timeout's error message
  // is more specific.
  const double patience_s = std::max(options.patience_s, options.recording.empty() ? 0 : 30.0);
  Watchdog watchdog(std::chrono::duration<double>(patience_s + 1), bite(options, quiet, clean_up));
  context.progress("capture", 0);
  HP_ASSIGN_OR_RETURN(auto camera, open(options));
  watchdog.feed();
  HP_RETURN_IF_ERROR(recording.start(*camera));
  HP_ASSIGN_OR_RETURN(const CapturedFrames taken,
                      take_frames(*camera, options, context, [&] { watchdog.feed(); }));
  HP_RETURN_IF_ERROR(recording.finish(*camera));
  const depth_camera::SourceInfo source = camera->info();
  watchdog.feed();
  camera.reset();
  HP_RETURN_IF_ERROR(folder.create());
  Context writing = context;
  writing.cancelled = [&] {
    watchdog.feed();
    return termination.requested();
  };
  HP_RETURN_IF_ERROR(write_frames(folder.partial(), source, taken, writing));
  termination.decide();
  HP_RETURN_IF_ERROR(folder.commit());
  return Summary{folder.dir(), taken.frames.size(), taken.lost};
}

/// Writes live pictures until a signal or an error ends it.
Status live(const Options& options, worker::Termination& termination,
            const worker::QuietStderr& quiet) {
  (void)::nice(kNiceness);  // lower priority than the rig and computations
  Context context;
  context.cancelled = [&termination] { return termination.requested(); };
  // The watchdog waits longer than the camera's own timeout, because that timeout's error message
  // is more specific.
  Watchdog watchdog(std::chrono::duration<double>(options.patience_s + 1),
                    bite(options, quiet, [] {}));
  HP_ASSIGN_OR_RETURN(auto camera, open(options));
  return show_live(
      *camera, options, context, [&] { watchdog.feed(); }, STDOUT_FILENO);
}

void sum_up(const Summary& summary, bool json) {
  const nlohmann::ordered_json object = {
      {"out", summary.dir.string()}, {"frames", summary.frames}, {"lost_frames", summary.lost}};
  const std::string text =
      json ? object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)
           : fmt::format("{}: {} frames, {} lost", summary.dir.string(), summary.frames,
                         summary.lost);
  std::puts(text.c_str());
}

/// Returns nullopt after live pictures, which have no summary. Converts exceptions to errors.
Result<std::optional<Summary>> run_guarded(const Options& options, worker::Termination& termination,
                                           const worker::QuietStderr& quiet) {
  try {
    if (!options.live) return run(options, termination, quiet);
    HP_RETURN_IF_ERROR(live(options, termination, quiet));
    return std::nullopt;
  } catch (const std::exception& error) {
    return fail(Code::kInternal, std::string(error.what()) + ". Please report this");
  }
}

int main_of(int argc, char** argv) {
  const CommandLine command = parse_command_line(argc, argv);
  if (!command.runs) {
    std::fputs(command.text.c_str(), command.status == 0 ? stdout : stderr);
    return command.status;
  }
  const bool json = command.options.json;
  const worker::QuietStderr quiet;
  worker::Termination termination([&quiet, json] {
    quiet.restore();
    print_error({Code::kCancelled, "cancelled", {}, {}}, json);
  });
  const Result<std::optional<Summary>> summary = run_guarded(command.options, termination, quiet);
  termination.decide();
  quiet.restore();
  if (summary) {
    if (*summary) sum_up(**summary, json);
    return 0;
  }
  print_error(summary.error(), json);
  return static_cast<int>(exit_status(summary.error()));
}

}  // namespace
}  // namespace hydroprint::capture

int main(int argc, char** argv) { return hydroprint::capture::main_of(argc, argv); }
