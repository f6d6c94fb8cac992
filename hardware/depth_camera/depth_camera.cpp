#include "hardware/depth_camera/depth_camera.h"

#include <OpenNI.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <utility>
#include <vector>

#include "sim/base/input_file.h"

namespace hydroprint::depth_camera {
namespace {

constexpr int kWidth_px = 640;
constexpr int kHeight_px = 480;
constexpr int kRate_hz = 30;
/// Timeout for reading a frame of a recording.
constexpr std::chrono::seconds kReadTime{20};

/// Returns OpenNI2's extended error text, on one line.
std::string details() {
  std::string out = openni::OpenNI::getExtendedError();
  for (char& c : out) {
    if (c == '\n' || c == '\t') c = ' ';
  }
  while (out.ends_with(' ')) out.pop_back();
  out.erase(0, out.find_first_not_of(' '));
  return out.empty() ? "" : " (" + out + ")";
}

Status initialise() {
  static const openni::Status status = openni::OpenNI::initialize();
  if (status == openni::STATUS_OK) return {};
  return fail(
      Code::kInternal,
      "OpenNI2 does not start" + details() + ". Install the packages of deploy/packages.txt",
      ErrorReason::CAMERA_UNUSABLE);
}

tl::unexpected<Error> unusable(const std::string& uri, const std::string& what) {
  return fail(Code::kFailedPrecondition,
              fmt::format("{}: {}{}. Use a depth camera with 640 x 480 pixels at 30 Hz", uri, what,
                          details()),
              ErrorReason::CAMERA_UNUSABLE);
}

/// Records whether the camera has been unplugged.
class DisconnectListener : public openni::OpenNI::DeviceDisconnectedListener {
 public:
  explicit DisconnectListener(std::string uri) : uri_(std::move(uri)) {
    openni::OpenNI::addDeviceDisconnectedListener(this);
  }
  ~DisconnectListener() { openni::OpenNI::removeDeviceDisconnectedListener(this); }
  DisconnectListener(const DisconnectListener&) = delete;
  DisconnectListener& operator=(const DisconnectListener&) = delete;

  void onDeviceDisconnected(const openni::DeviceInfo* info) override {
    if (uri_ == info->getUri()) happened_ = true;
  }
  [[nodiscard]] bool happened() const { return happened_; }

 private:
  std::string uri_;
  std::atomic<bool> happened_ = false;
};

/// A device and its depth stream.
struct Opened {
  openni::Device device;
  openni::VideoStream stream;
};

/// Keeps a recording open. OpenNI 2.2 plays a recording in a thread that goes through the streams
/// of the device without a lock, and crashes if one is destroyed meanwhile.
void keep_until_exit(std::unique_ptr<Opened> opened) {
  static auto* const kept = new std::vector<std::unique_ptr<Opened>>;  // never destroyed
  kept->push_back(std::move(opened));
}

class OpenNiCamera : public DepthCamera {
 public:
  ~OpenNiCamera() override {
    finish_recording();
    if (device_.isValid() && device_.isFile()) {
      keep_until_exit(std::move(opened_));
      return;
    }
    stream_.destroy();
    device_.close();
  }

  [[nodiscard]] Status open(const std::string& uri);
  [[nodiscard]] Status start_device();
  [[nodiscard]] Status start_recording(const std::filesystem::path& path);

  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] Result<std::optional<DepthFrame>> next(std::chrono::milliseconds timeout) override;
  [[nodiscard]] Status record(const std::filesystem::path& path) override;
  void finish_recording() override {
    // Stops the stream first, so that no frame reaches a recorder that is being destroyed.
    if (stream_.isValid()) stream_.stop();
    recorder_.destroy();
  }

 private:
  [[nodiscard]] Status choose_mode();
  [[nodiscard]] tl::unexpected<Error> no_frame() const;
  [[nodiscard]] Result<std::optional<DepthFrame>> read();

  std::unique_ptr<Opened> opened_ = std::make_unique<Opened>();
  openni::Device& device_ = opened_->device;
  openni::VideoStream& stream_ = opened_->stream;
  openni::Recorder recorder_;
  std::unique_ptr<DisconnectListener> disconnect_listener_;
  SourceInfo info_;
  int frames_read_ = 0;  // number of frames read so far
};

Status OpenNiCamera::open(const std::string& uri) {
  HP_RETURN_IF_ERROR(initialise());
  const char* const wanted = uri.empty() ? openni::ANY_DEVICE : uri.c_str();
  if (device_.open(wanted) != openni::STATUS_OK) {
    return fail(Code::kNotFound,
                (uri.empty() ? "no depth camera is plugged in" : uri + ": no such depth camera") +
                    details() + ". Plug in the camera, or correct its name",
                ErrorReason::CAMERA_NOT_FOUND);
  }
  const openni::DeviceInfo& info = device_.getDeviceInfo();
  info_.uri = info.getUri();
  info_.name = fmt::format("{} {}", info.getVendor(), info.getName());
  return {};
}

Status OpenNiCamera::choose_mode() {
  const openni::SensorInfo* sensor = device_.getSensorInfo(openni::SENSOR_DEPTH);
  if (sensor == nullptr || stream_.create(device_, openni::SENSOR_DEPTH) != openni::STATUS_OK) {
    return unusable(info_.uri, "has no depth stream");
  }
  const auto& modes = sensor->getSupportedVideoModes();
  for (int i = 0; i < modes.getSize(); ++i) {
    if (modes[i].getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM &&
        modes[i].getResolutionX() == kWidth_px && modes[i].getResolutionY() == kHeight_px &&
        modes[i].getFps() == kRate_hz && stream_.setVideoMode(modes[i]) == openni::STATUS_OK) {
      return {};
    }
  }
  return unusable(info_.uri, "does not support this frame size and rate");
}

Status OpenNiCamera::start_device() {
  disconnect_listener_ = std::make_unique<DisconnectListener>(info_.uri);
  HP_RETURN_IF_ERROR(choose_mode());
  std::array<char, 256> serial{};
  int size = serial.size() - 1;
  if (device_.getProperty(openni::DEVICE_PROPERTY_SERIAL_NUMBER, serial.data(), &size) ==
      openni::STATUS_OK) {
    info_.serial = serial.data();
  }
  (void)stream_.setMirroringEnabled(false);  // may fail on devices that cannot mirror
  if (stream_.start() != openni::STATUS_OK) return unusable(info_.uri, "does not start");
  info_.width = kWidth_px;
  info_.height = kHeight_px;
  return {};
}

Status OpenNiCamera::start_recording(const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& what) {
    return fail(
        Code::kDataLoss,
        fmt::format("{}: {}{}. Use an OpenNI2 recording (.oni)", path.string(), what, details()),
        ErrorReason::RECORDING_INVALID);
  };
  HP_RETURN_IF_ERROR(initialise());
  if (device_.open(path.c_str()) != openni::STATUS_OK || !device_.isFile()) {
    return refuse("not a recording");
  }
  info_ = {path.string(), "recording", "", 0, 0, 0};
  if (stream_.create(device_, openni::SENSOR_DEPTH) != openni::STATUS_OK) {
    return refuse("has no depth stream");
  }
  openni::PlaybackControl* const playback = device_.getPlaybackControl();
  // Frames are lost unless the recording is stepped manually (speed -1); seeking crashes OpenNI
  // 2.2.
  if (playback == nullptr || playback->setSpeed(-1) != openni::STATUS_OK ||
      playback->setRepeatEnabled(false) != openni::STATUS_OK) {
    return refuse("cannot be played frame by frame");
  }
  const openni::VideoMode mode = stream_.getVideoMode();
  info_.width = mode.getResolutionX();
  info_.height = mode.getResolutionY();
  info_.frames = playback->getNumberOfFrames(stream_);
  if (mode.getPixelFormat() != openni::PIXEL_FORMAT_DEPTH_1_MM || *info_.frames < 1 ||
      info_.width < 1 || info_.width > 4096 || info_.height < 1 || info_.height > 4096) {
    return refuse("contains no depth frames in the 1 mm format");
  }
  if (stream_.start() != openni::STATUS_OK) return refuse("does not start");
  return {};
}

tl::unexpected<Error> OpenNiCamera::no_frame() const {
  if (info_.frames) {
    return fail(Code::kDataLoss,
                fmt::format("{}: ends after {} of {} frames. Record it again", info_.uri,
                            frames_read_, *info_.frames),
                ErrorReason::RECORDING_INVALID);
  }
  return fail(Code::kUnavailable,
              info_.uri + ": no frame arrived in time. Unplug the camera and plug it in again",
              ErrorReason::CAMERA_STALLED);
}

Result<std::optional<DepthFrame>> OpenNiCamera::next(std::chrono::milliseconds timeout) {
  if (info_.frames && frames_read_ >= *info_.frames) return std::optional<DepthFrame>();
  openni::VideoStream* stream = &stream_;
  int ready = 0;
  const auto wait =
      info_.frames ? std::max<std::chrono::milliseconds>(timeout, kReadTime) : timeout;
  // readFrame() alone would wait forever.
  const openni::Status status =
      openni::OpenNI::waitForAnyStream(&stream, 1, &ready, static_cast<int>(wait.count()));
  if (disconnect_listener_ && disconnect_listener_->happened()) {
    return fail(Code::kUnavailable,
                info_.uri + ": the camera was disconnected. Check its cable and plug it in again",
                ErrorReason::CAMERA_GONE);
  }
  if (status != openni::STATUS_OK) return no_frame();
  return read();
}

Result<std::optional<DepthFrame>> OpenNiCamera::read() {
  openni::VideoFrameRef frame;
  if (stream_.readFrame(&frame) != openni::STATUS_OK || !frame.isValid()) return no_frame();
  const auto width = static_cast<std::size_t>(frame.getWidth());
  const auto height = static_cast<std::size_t>(frame.getHeight());
  const auto stride = static_cast<std::size_t>(frame.getStrideInBytes());
  if (frame.getWidth() != info_.width || frame.getHeight() != info_.height || stride < 2 * width ||
      static_cast<std::size_t>(frame.getDataSize()) < stride * height) {
    return no_frame();
  }
  DepthFrame out{info_.width,
                 info_.height,
                 std::vector<std::uint16_t>(width * height),
                 static_cast<double>(frame.getTimestamp()) / 1e6,
                 frame.getFrameIndex(),
                 stream_.getHorizontalFieldOfView(),
                 stream_.getVerticalFieldOfView()};
  for (std::size_t y = 0; y < height; ++y) {
    const auto* const row = static_cast<const unsigned char*>(frame.getData()) + y * stride;
    std::memcpy(&out.depth_mm[y * width], row, 2 * width);
  }
  ++frames_read_;
  return std::optional<DepthFrame>(std::move(out));
}

Status OpenNiCamera::record(const std::filesystem::path& path) {
  const bool starts = recorder_.create(path.c_str()) == openni::STATUS_OK &&
                      recorder_.attach(stream_) == openni::STATUS_OK &&
                      recorder_.start() == openni::STATUS_OK;
  if (starts) return {};
  recorder_.destroy();
  return fail(Code::kPermissionDenied, fmt::format("{}: cannot be written{}. Choose another file",
                                                   path.string(), details()));
}

}  // namespace

Result<std::unique_ptr<DepthCamera>> DepthCamera::open_device(const std::string& uri) {
  auto out = std::make_unique<OpenNiCamera>();
  HP_RETURN_IF_ERROR(out->open(uri));
  HP_RETURN_IF_ERROR(out->start_device());
  return std::unique_ptr<DepthCamera>(std::move(out));
}

Result<std::unique_ptr<DepthCamera>> DepthCamera::open_recording(
    const std::filesystem::path& path) {
  if (const auto file = open_input_file(path); !file) return tl::unexpected(file.error());
  auto out = std::make_unique<OpenNiCamera>();
  // OpenNI2 changes the working directory while it loads drivers.
  HP_RETURN_IF_ERROR(out->start_recording(std::filesystem::absolute(path)));
  return std::unique_ptr<DepthCamera>(std::move(out));
}

}  // namespace hydroprint::depth_camera
