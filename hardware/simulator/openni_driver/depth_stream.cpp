#include "hardware/simulator/openni_driver/depth_stream.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "hardware/simulator/camera/lens.h"
#include "hardware/simulator/scene/codec.h"

namespace hydroprint::openni_driver {
namespace {

using Clock = std::chrono::steady_clock;

template <class Value>
OniStatus give(const Value& value, void* data, int* size) {
  if (data == nullptr || size == nullptr || *size != static_cast<int>(sizeof value)) {
    return ONI_STATUS_BAD_PARAMETER;
  }
  std::memcpy(data, &value, sizeof value);
  return ONI_STATUS_OK;
}

}  // namespace

DepthStream::DepthStream(const simulated_scene::Scenery& scenery,
                         simulated_camera::Renderer& renderer, std::string control,
                         std::function<void()> on_gone)
    : renderer_(renderer),
      counts_frames_(scenery.counts_frames),
      control_(std::move(control)),
      on_gone_(std::move(on_gone)),
      last_(static_cast<std::size_t>(simulated_camera::kWidth_px) * simulated_camera::kHeight_px) {}

DepthStream::~DepthStream() { stop(); }

OniVideoMode DepthStream::mode() {
  return {ONI_PIXEL_FORMAT_DEPTH_1_MM, simulated_camera::kWidth_px, simulated_camera::kHeight_px,
          simulated_camera::kRate_hz};
}

OniStatus DepthStream::getProperty(int id, void* data, int* size) {
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
      return give(mode(), data, size);
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      return give(static_cast<float>(simulated_camera::horizontal_fov_rad()), data, size);
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
      return give(static_cast<float>(simulated_camera::vertical_fov_rad()), data, size);
    case ONI_STREAM_PROPERTY_MIN_VALUE:
      return give(simulated_camera::kLeast_mm, data, size);
    case ONI_STREAM_PROPERTY_MAX_VALUE:
      // A recording alters depths above this value.
      return give(simulated_camera::kMost_mm, data, size);
    case ONI_STREAM_PROPERTY_CROPPING:
      // Without this property, the player of recordings drops every frame.
      return give(OniCropping{0, 0, 0, simulated_camera::kWidth_px, simulated_camera::kHeight_px},
                  data, size);
    case ONI_STREAM_PROPERTY_MIRRORING:
      return give(OniBool{FALSE}, data, size);
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus DepthStream::setProperty(int id, const void* data, int size) {
  if (id == ONI_STREAM_PROPERTY_VIDEO_MODE && size == static_cast<int>(sizeof(OniVideoMode))) {
    const OniVideoMode only = mode();
    return std::memcmp(data, &only, sizeof only) == 0 ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
  }
  if (id == ONI_STREAM_PROPERTY_MIRRORING && size == static_cast<int>(sizeof(OniBool))) {
    return *static_cast<const OniBool*>(data) == FALSE ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
  }
  return ONI_STATUS_NOT_SUPPORTED;
}

OniBool DepthStream::isPropertySupported(int id) {
  return id == ONI_STREAM_PROPERTY_CROPPING || id == ONI_STREAM_PROPERTY_MIRRORING ||
                 (id >= ONI_STREAM_PROPERTY_HORIZONTAL_FOV && id <= ONI_STREAM_PROPERTY_MIN_VALUE)
             ? TRUE
             : FALSE;
}

OniStatus DepthStream::start() {
  auto line = RigLine::connect(control_);
  if (!line) return ONI_STATUS_ERROR;
  const auto sight = line->ask_until_deadline("sight").and_then(
      [](const std::string& text) { return simulated_scene::sight_of(text); });
  if (sight && sight->camera == simulated_scene::CameraState::kHung) {
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));  // like a real driver that hangs
  }
  stop();
  ends_ = false;
  thread_ = std::thread([this](RigLine mine) { run(std::move(mine)); }, std::move(*line));
  return ONI_STATUS_OK;
}

void DepthStream::stop() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool DepthStream::wait_until(Clock::time_point time) {
  std::unique_lock lock(mutex_);
  return !wakes_.wait_until(lock, time, [this] { return ends_; });
}

void DepthStream::run(RigLine line) {
  constexpr auto kPeriod =
      std::chrono::nanoseconds(std::chrono::seconds(1)) / simulated_camera::kRate_hz;
  auto due = Clock::now();
  for (int index = 1; wait_until(due); ++index) {
    if (!tell_frame(line, index)) {
      on_gone_();
      return;
    }
    due += kPeriod;
    // A renderer that is too slow loses frames, as a camera does, except with clock = "frames".
    for (; due < Clock::now(); due += kPeriod) {
      if (!counts_frames_) ++index;
    }
  }
}

bool DepthStream::tell_frame(RigLine& line, int index) {
  const auto reply = line.ask("sight").and_then(
      [](const std::string& text) { return simulated_scene::sight_of(text); });
  // A rig that is stopped does not reply: then no frame arrives, as from a camera that hangs.
  if (!reply) return reply.error().code == Code::kAborted;
  simulated_scene::Sight sight = *reply;
  if (sight.camera == simulated_scene::CameraState::kGone) return false;
  if (counts_frames_) sight.time_s = static_cast<double>(index - 1) / simulated_camera::kRate_hz;
  if (sight.camera == simulated_scene::CameraState::kBlack) {
    std::fill(last_.begin(), last_.end(), std::uint16_t{0});
  } else if (sight.camera == simulated_scene::CameraState::kWell) {
    last_ = renderer_.photograph(sight, index);
  }
  publish(index, sight.time_s);
  return true;
}

void DepthStream::publish(int index, double time_s) {
  OniFrame* frame = getServices().acquireFrame();
  if (frame == nullptr) return;
  frame->frameIndex = index;
  frame->timestamp = static_cast<std::uint64_t>(std::llround(time_s * 1e6));
  frame->videoMode = mode();
  frame->width = simulated_camera::kWidth_px;
  frame->height = simulated_camera::kHeight_px;
  frame->stride = simulated_camera::kWidth_px * static_cast<int>(sizeof(std::uint16_t));
  frame->cropOriginX = frame->cropOriginY = 0;
  frame->croppingEnabled = FALSE;
  frame->sensorType = ONI_SENSOR_DEPTH;
  const std::size_t bytes = last_.size() * sizeof last_[0];
  if (frame->dataSize >= static_cast<int>(bytes)) {
    std::memcpy(frame->data, last_.data(), bytes);
    frame->dataSize = static_cast<int>(bytes);
    raiseNewFrame(frame);
  }
  getServices().releaseFrame(frame);
}

}  // namespace hydroprint::openni_driver
