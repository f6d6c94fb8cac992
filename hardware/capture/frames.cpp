#include "hardware/capture/frames.h"

#include <algorithm>
#include <utility>

#include "hardware/depth_camera/frame_watch.h"

namespace hydroprint::capture {
namespace {

using std::chrono::milliseconds;

constexpr double kUsualSeconds = 2;
constexpr milliseconds kSlice{200};  ///< interval between checks for cancellation during a wait
constexpr std::string_view kStage = "capture";

}  // namespace

Result<std::optional<depth_camera::DepthFrame>> next_frame(depth_camera::DepthCamera& camera,
                                                           const Options& options,
                                                           const Context& context,
                                                           const std::function<void()>& alive) {
  for (double waited_s = 0;;) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    alive();
    auto frame = camera.next(kSlice);
    waited_s += std::chrono::duration<double>(kSlice).count();
    const bool comes_late = !frame && frame.error().reason == ErrorReason::CAMERA_STALLED;
    if (!comes_late || waited_s >= options.patience_s) return frame;
  }
}

Result<CapturedFrames> take_frames(depth_camera::DepthCamera& camera, const Options& options,
                                   const Context& context, const std::function<void()>& alive) {
  const auto all = camera.info().frames;
  const double seconds = options.seconds.value_or(all ? kMostSeconds : kUsualSeconds);
  depth_camera::FrameWatch watch(camera.info().uri);
  CapturedFrames out;
  std::optional<double> start_s;
  int index = 0;
  for (int count = 1;; ++count) {
    HP_ASSIGN_OR_RETURN(auto frame, next_frame(camera, options, context, alive));
    if (!frame) break;
    HP_RETURN_IF_ERROR(watch.look(*frame));
    if (index > 0) out.lost += std::max(0, frame->index - index - 1);
    index = frame->index;
    start_s = start_s.value_or(frame->time_s);
    const double passed_s = frame->time_s - *start_s;
    // The tolerance is half a frame period at 30 frames/s: durations are rounded to whole frames.
    if (passed_s >= seconds - 0.5 / 30) break;
    if (watch.good()) {
      out.frames.push_back(std::move(*frame));
    } else {
      ++out.left_out;
    }
    context.progress(kStage, all ? count / static_cast<double>(*all) : passed_s / seconds);
  }
  if (out.frames.empty()) {
    return fail(Code::kDataLoss, camera.info().uri + ": contains no usable frame. Record it again",
                ErrorReason::RECORDING_INVALID);
  }
  context.progress(kStage, 1);
  return out;
}

}  // namespace hydroprint::capture
