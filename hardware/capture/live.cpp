#include "hardware/capture/live.h"

#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <string>

#include "hardware/capture/depth_picture.h"
#include "hardware/capture/frames.h"
#include "hardware/depth_camera/frame_watch.h"
#include "sim/image/io/image_file.h"
#include "sim/image/io/png.h"

namespace hydroprint::capture {
namespace {

Status write_all(int to, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(to, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      return fail(Code::kUnavailable,
                  "the process that reads the pictures has closed the connection");
    done += static_cast<std::size_t>(count);
  }
  return {};
}

Result<std::string> message_of(const depth_camera::DepthFrame& frame,
                               const depth_camera::SourceInfo& source, const Context& context) {
  const DepthPicture shown = depth_picture(frame);
  HP_ASSIGN_OR_RETURN(const auto png, image::encode_png(shown.picture, image::kScreenDpi, context));
  const nlohmann::ordered_json head = {{"bytes", png.size()},
                                       {"width", shown.picture.width},
                                       {"height", shown.picture.height},
                                       {"nearest_mm", shown.nearest_mm},
                                       {"farthest_mm", shown.farthest_mm},
                                       {"measured_share", shown.measured_share},
                                       {"camera", source.name}};
  std::string out = head.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  return out.append(png.begin(), png.end());
}

}  // namespace

Status show_live(depth_camera::DepthCamera& camera, const Options& options, const Context& context,
                 const std::function<void()>& alive, int to) {
  depth_camera::FrameWatch watch(camera.info().uri);
  for (double due_s = 0;;) {
    HP_ASSIGN_OR_RETURN(const auto frame, next_frame(camera, options, context, alive));
    if (!frame) return fail(Code::kUnavailable, camera.info().uri + ": no more frames");
    HP_RETURN_IF_ERROR(watch.look(*frame));
    if (!watch.good() || frame->time_s < due_s) continue;
    due_s = frame->time_s + options.every_s;
    HP_ASSIGN_OR_RETURN(const std::string message, message_of(*frame, camera.info(), context));
    HP_RETURN_IF_ERROR(write_all(to, message));
  }
}

}  // namespace hydroprint::capture
