// The virtual rig's depth camera as an OpenNI2 driver module. OpenNI2 finds it by its file name
// (lib*.so.0), and opens it as hydroprint:CONTROL, the control socket of hydroprint-virtual-rig.

#include <cstring>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "hardware/simulator/openni_driver/depth_stream.h"
#include "hardware/simulator/scene/codec.h"

namespace hydroprint::openni_driver {
namespace {

constexpr std::string_view kScheme = "hydroprint:";

Result<simulated_scene::Scenery> ask_scenery(const std::string& control) {
  HP_ASSIGN_OR_RETURN(RigLine line, RigLine::connect(control));
  HP_ASSIGN_OR_RETURN(const std::string text, line.ask_until_deadline("scenery"));
  HP_ASSIGN_OR_RETURN(const std::string now, line.ask_until_deadline("sight"));
  HP_ASSIGN_OR_RETURN(const simulated_scene::Sight sight, simulated_scene::sight_of(now));
  if (sight.camera == simulated_scene::CameraState::kGone) {
    return fail(Code::kUnavailable, "the camera is not plugged in");
  }
  return simulated_scene::scenery_of(text);
}

class Device : public oni::driver::DeviceBase {
 public:
  Device(simulated_scene::Scenery scenery, std::unique_ptr<simulated_camera::Renderer> renderer,
         std::string control, std::function<void()> on_gone)
      : scenery_(std::move(scenery)),
        renderer_(std::move(renderer)),
        control_(std::move(control)),
        on_gone_(std::move(on_gone)) {}

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = &sensor_;
    *count = 1;
    return ONI_STATUS_OK;
  }

  oni::driver::StreamBase* createStream(OniSensorType sensor) override {
    if (sensor != ONI_SENSOR_DEPTH || stream_ != nullptr) return nullptr;
    stream_ = std::make_unique<DepthStream>(scenery_, *renderer_, control_, on_gone_);
    return stream_.get();
  }

  void destroyStream(oni::driver::StreamBase* /*stream*/) override { stream_.reset(); }

  OniStatus getProperty(int id, void* data, int* size) override {
    if (id != ONI_DEVICE_PROPERTY_SERIAL_NUMBER) return ONI_STATUS_NOT_SUPPORTED;
    const std::string serial = "virtual-" + std::to_string(scenery_.seed);
    if (*size <= static_cast<int>(serial.size())) return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(data, serial.c_str(), serial.size() + 1);
    *size = static_cast<int>(serial.size()) + 1;
    return ONI_STATUS_OK;
  }

  OniBool isPropertySupported(int id) override {
    return id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER ? TRUE : FALSE;
  }

 private:
  simulated_scene::Scenery scenery_;
  std::unique_ptr<simulated_camera::Renderer> renderer_;
  std::string control_;
  std::function<void()> on_gone_;
  OniVideoMode mode_ = DepthStream::mode();
  OniSensorInfo sensor_{ONI_SENSOR_DEPTH, 1, &mode_};
  std::unique_ptr<DepthStream> stream_;
};

}  // namespace

class Driver : public oni::driver::DriverBase {
 public:
  explicit Driver(OniDriverServices* services) : DriverBase(services) {}

  OniStatus tryDevice(const char* uri) override {
    const std::string_view text(uri);
    if (!text.starts_with(kScheme) || text.size() >= ONI_MAX_STR) return ONI_STATUS_ERROR;
    if (!known(text)) return ONI_STATUS_NO_DEVICE;
    return ONI_STATUS_OK;
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char* /*mode*/) override {
    const std::string control(std::string_view(uri).substr(kScheme.size()));
    const OniDeviceInfo* info = known(uri);
    auto scenery = ask_scenery(control);
    if (info == nullptr || !scenery) return complain(scenery ? "" : scenery.error().message);
    auto renderer =
        simulated_camera::Renderer::create(*scenery, simulated_camera::lens_of(*scenery));
    if (!renderer) return complain(renderer.error().message);
    return new Device(std::move(*scenery), std::move(*renderer), control,
                      [this, info] { deviceDisconnected(info); });
  }

  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }

  void shutdown() override {}

 private:
  std::nullptr_t complain(const std::string& message) {
    getServices().errorLoggerAppend("%s", message.c_str());
    return nullptr;
  }

  /// Returns the information under which the camera is registered with OpenNI2; registers the
  /// camera first if necessary. Returns nullptr if the camera does not exist. OpenNI2 identifies a
  /// camera by the memory address of this information.
  const OniDeviceInfo* known(std::string_view uri) {
    const std::scoped_lock lock(mutex_);
    for (const OniDeviceInfo& info : infos_) {
      if (uri == info.uri) return &info;
    }
    const auto scenery = ask_scenery(std::string(uri.substr(kScheme.size())));
    if (!scenery) return complain(scenery.error().message);
    OniDeviceInfo info{};
    uri.copy(info.uri, sizeof info.uri - 1);
    std::string_view("Hydroprint").copy(info.vendor, sizeof info.vendor - 1);
    std::string_view("virtual rig").copy(info.name, sizeof info.name - 1);
    infos_.push_back(info);
    deviceConnected(&infos_.back());
    return &infos_.back();
  }

  std::mutex mutex_;
  std::list<OniDeviceInfo> infos_;
};

}  // namespace hydroprint::openni_driver

ONI_EXPORT_DRIVER(hydroprint::openni_driver::Driver)
