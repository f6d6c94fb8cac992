#include "hardware/simulator/drive/virtual_rig.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include "hardware/simulator/drive/reply_bytes.h"
#include "hardware/simulator/drive/tcp_server.h"
#include "sim/base/process/real_time_thread.h"

namespace hydroprint::simulated_drive {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTick{5};
constexpr std::size_t kLongestLine = 4096;
// Below kDrivePriority, because an action may read a mesh. Not an ordinary priority, because
// actions hold the plant's lock, for which the threads of the drive would wait.
constexpr int kControlPriority = 1;

Registers registers_of(const Options& options) {
  const auto& watchdog = options.profile.watchdog;
  const double time_s = options.watchdog_s.value_or(watchdog ? watchdog->largest_time_s : 0);
  const bool has_action = watchdog && !watchdog->stopping.empty();
  const std::uint16_t first = has_action ? watchdog->stopping.front() : std::uint16_t{0};
  return {options.profile, time_s, options.watchdog_action.value_or(first)};
}

}  // namespace

Machine machine_of(const drive::DriveProfile& profile, const Scene& scene) {
  Machine out;
  out.travel_mm = scene.travel_mm;
  out.max_speed_mm_per_s = profile.max_speed_mm_per_s;
  out.acceleration_mm_per_s2 = profile.acceleration_mm_per_s2;
  out.stopping_deceleration_mm_per_s2 = profile.stopping_deceleration_mm_per_s2;
  out.homing_speed_mm_per_s = std::min(
      profile.homing_speed_mm_per_s.value_or(out.homing_speed_mm_per_s), out.max_speed_mm_per_s);
  out.jog_dead_man_s = profile.jog_dead_man_s;
  out.enables_itself = profile.command(drive::Command::kEnable).empty();
  return out;
}

VirtualRig::VirtualRig(const Options& options)
    : options_(options),
      plant_(machine_of(options.profile, options.scene), registers_of(options),
             options.scene.start_mm),
      camera_control_(options.scene) {}

Result<std::unique_ptr<VirtualRig>> VirtualRig::start(const Options& options) {
  std::unique_ptr<VirtualRig> out(new VirtualRig(options));
  if (options.scene.camera) HP_RETURN_IF_ERROR(out->camera_control_.scenery_json());
  HP_RETURN_IF_ERROR(out->plug());
  if (!options.control.empty()) {
    HP_ASSIGN_OR_RETURN(out->control_,
                        SocketServer::local(options.control, [rig = out.get()](int descriptor) {
                          rig->serve_control(descriptor);
                        }));
  }
  out->clock_.emplace(kTick, [rig = out.get(), start = Clock::now(), is_first = true]() mutable {
    if (std::exchange(is_first, false)) (void)become_real_time(kDrivePriority);
    rig->tick(start);
  });
  return out;
}

VirtualRig::~VirtualRig() {
  if (control_) ::unlink(options_.control.c_str());
  control_.reset();
  clock_.reset();
  unplug();
}

Status VirtualRig::plug() {
  const std::scoped_lock lock(plugs_);
  if (options_.tcp_port && !tcp_) {
    // When plugged in again, uses the port of the first start.
    HP_ASSIGN_OR_RETURN(tcp_, serve_tcp(plant_, tcp_port_ > 0 ? tcp_port_ : *options_.tcp_port));
    if (tcp_port_ == 0) tcp_port_ = tcp_->port();
  }
  if (options_.line && !serial_) {
    HP_ASSIGN_OR_RETURN(serial_, SerialServer::start(plant_, *options_.line));
  }
  return {};
}

void VirtualRig::unplug() {
  const std::scoped_lock lock(plugs_);
  tcp_.reset();
  serial_.reset();
}

// A drive that boots keeps its serial line, whose adapter has its own power, and loses its TCP
// connections.
void VirtualRig::boot() {
  plant_.power_on();
  if (plug()) return;
  const std::scoped_lock lock(plugs_);
  boots_at_ = Clock::now() + kTick;
}

Result<std::string> VirtualRig::perform(const Action& action) {
  switch (action.kind) {
    case Action::Kind::kReplyFault:
      plant_.set_reply_fault(action.reply_fault);
      break;
    case Action::Kind::kClear:
      plant_.clear();
      camera_control_.clear();
      break;
    case Action::Kind::kPress:
    case Action::Kind::kRelease:
      plant_.press(action.input, action.kind == Action::Kind::kPress);
      break;
    case Action::Kind::kUnplug:
      unplug();
      break;
    case Action::Kind::kReplug:
      HP_RETURN_IF_ERROR(plug());
      break;
    case Action::Kind::kReboot: {
      plant_.power_off();
      const std::scoped_lock lock(plugs_);
      tcp_.reset();
      boots_at_ = Clock::now() + action.pause;
      break;
    }
    case Action::Kind::kCamera:
      camera_control_.set(action.camera);
      break;
    case Action::Kind::kMarker:
      HP_RETURN_IF_ERROR(camera_control_.set(action.name, action.marker));
      break;
    case Action::Kind::kPush:
      HP_RETURN_IF_ERROR(camera_control_.push(action.name, action.push_mm));
      break;
    case Action::Kind::kSetObject:
      HP_RETURN_IF_ERROR(camera_control_.set_object(action.name, action.mesh));
      break;
    case Action::Kind::kShow:
      HP_RETURN_IF_ERROR(camera_control_.show(action.name, action.mesh));
      break;
    case Action::Kind::kScenery:
      return camera_control_.scenery_json();
    case Action::Kind::kSight: {
      const auto [time_s, place_mm] = plant_.place();
      return camera_control_.sight_json(time_s, place_mm);
    }
    case Action::Kind::kState:
      return plant_.state_json();
    case Action::Kind::kHelp:
      return std::string(action_help());
  }
  return "ok";
}

std::string VirtualRig::reply_to(const std::string& line) {
  const auto reply = parse_action(line).and_then([this](const Action& a) { return perform(a); });
  return reply ? *reply : "error: " + reply.error().message;
}

void VirtualRig::serve_control(int descriptor) {
  (void)become_real_time(kControlPriority);
  std::string text;
  std::array<char, 512> chunk{};
  for (;;) {
    const ssize_t got = ::read(descriptor, chunk.data(), chunk.size());
    if (got <= 0) return;
    text.append(chunk.data(), static_cast<std::size_t>(got));
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
      const std::string reply = reply_to(text.substr(0, end)) + "\n";
      write_all(descriptor, {reinterpret_cast<const std::uint8_t*>(reply.data()), reply.size()});
      text.erase(0, end + 1);
    }
    if (text.size() > kLongestLine) return;
  }
}

void VirtualRig::tick(Clock::time_point start) {
  plant_.tick();
  const auto now = Clock::now();
  bool boots = false;
  {
    const std::scoped_lock lock(plugs_);
    boots = boots_at_ && now >= *boots_at_;
    if (boots) boots_at_.reset();
  }
  if (boots) boot();
  const auto is_due = [&](const TimedAction& timed) { return now >= start + timed.at; };
  for (const TimedAction& timed : options_.actions) {
    if (is_due(timed)) (void)perform(timed.action);
  }
  std::erase_if(options_.actions, is_due);
}

}  // namespace hydroprint::simulated_drive
