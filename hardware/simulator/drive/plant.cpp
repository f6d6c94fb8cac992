#include "hardware/simulator/drive/plant.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "hardware/drive/pdu.h"

namespace hydroprint::simulated_drive {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Request = std::span<const std::uint8_t>;

constexpr std::uint8_t kReadHolding = 3;
constexpr std::uint8_t kReadInput = 4;
constexpr std::uint8_t kWriteOne = 6;
constexpr std::uint8_t kWriteMany = 16;
constexpr std::uint8_t kNoSuchFunction = 1;
constexpr std::uint8_t kNoSuchRegister = 2;
constexpr std::uint8_t kNoSuchValue = 3;
constexpr std::uint8_t kNotNow = 4;
constexpr std::uint8_t kBusy = 6;

constexpr std::array<std::string_view, 9> kModes = {"off",          "hold",         "move",
                                                    "jog",          "home_seek",    "home_back_off",
                                                    "home_to_zero", "stop_to_hold", "stop_to_off"};

std::uint16_t word_at(Request bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8U | bytes[at + 1]);
}

Bytes exception(Request request, std::uint8_t code) {
  return {request[0], static_cast<std::uint8_t>(request[1] | 0x80U), code};
}

/// Returns the words of a write; empty if it is malformed.
std::vector<std::uint16_t> written(Request request) {
  if (request[1] == kWriteOne) return {word_at(request, 4)};
  const std::size_t count = word_at(request, 4);
  if (count > drive::kMaxWriteWords || request.size() != 7 + 2 * count || request[6] != 2 * count) {
    return {};
  }
  std::vector<std::uint16_t> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = word_at(request, 7 + 2 * i);
  return out;
}

}  // namespace

Plant::Plant(const Machine& machine, Registers registers, double start_mm)
    : machine_(machine), registers_(std::move(registers)), model_(switched_on(start_mm)) {
  update_registers();
}

int Plant::unit() const { return registers_.profile().unit; }

void Plant::catch_up() {
  const std::chrono::duration<double> now = std::chrono::steady_clock::now() - start_;
  machine_.watchdog_s = registers_.watchdog_s();
  machine_.watchdog_action = registers_.watchdog_action();
  model_ = step(machine_, model_, inputs_, now.count() - model_.time_s);
}

void Plant::update_registers() {
  const Kinematics now = feedback(model_, inputs_);
  drive::DriveState state;
  state.position_mm = now.x_mm;
  state.velocity_mm_per_s = now.v_mm_per_s;
  state.demand_mm = model_.demand.x_mm - model_.zero_mm;
  state.enabled = model_.enabled();
  state.homed = model_.homed;
  state.moving = model_.moving();
  state.alarm = model_.alarm != kNoAlarm;
  state.positive_end = at_positive_end(machine_, model_, inputs_);
  state.negative_end = at_negative_end(machine_, model_, inputs_);
  state.home_switch = at_home_switch(model_);
  state.stop_input = inputs_.stop_button;
  state.alarm_code = model_.alarm;
  registers_.set_state(state);
}

ReplyFault Plant::next_fault(bool is_write) {
  if (fault_.count == 0 || (fault_.writes_only && !is_write)) return {};
  if (fault_.fault == ReplyFaultKind::kDropRequest) fault_.writes_only = false;
  if (fault_.count > 0) --fault_.count;
  return fault_;
}

Answer Plant::answer(Request request) {
  const std::scoped_lock lock(mutex_);
  catch_up();
  if (!powered_ || request.size() < 6 || request[0] != unit()) return {};
  const ReplyFault reply_fault = next_fault(request[1] == kWriteOne || request[1] == kWriteMany);
  if (reply_fault.fault == ReplyFaultKind::kDropRequest) return {{}, reply_fault};
  ++requests_;
  model_.heard_s = model_.time_s;
  if (reply_fault.fault == ReplyFaultKind::kBusy) return {exception(request, kBusy), reply_fault};
  return {serve_request(request), reply_fault};
}

Bytes Plant::serve_request(Request request) {
  switch (request[1]) {
    case kReadHolding:
    case kReadInput:
      return serve_read(request);
    case kWriteOne:
    case kWriteMany:
      return serve_write(request);
    default:
      return exception(request, kNoSuchFunction);
  }
}

Bytes Plant::serve_read(Request request) {
  const std::size_t count = word_at(request, 4);
  if (count < 1 || count > drive::kMaxReadWords) return exception(request, kNoSuchValue);
  update_registers();
  const auto space = request[1] == kReadHolding ? drive::Space::kHolding : drive::Space::kInput;
  const auto words = registers_.read(space, word_at(request, 2), count);
  if (!words) return exception(request, kNoSuchRegister);
  Bytes out = {request[0], request[1], static_cast<std::uint8_t>(2 * count)};
  for (const std::uint16_t word : *words) {
    out.push_back(static_cast<std::uint8_t>(word >> 8U));
    out.push_back(static_cast<std::uint8_t>(word & 0xffU));
  }
  return out;
}

Bytes Plant::serve_write(Request request) {
  const std::uint16_t address = word_at(request, 2);
  const auto words = written(request);
  if (words.empty()) return exception(request, kNoSuchValue);
  if (!registers_.write(address, words)) return exception(request, kNoSuchRegister);
  if (const auto order = registers_.order(address, words)) {
    const auto after = execute(machine_, model_, inputs_, *order);
    if (!after) return exception(request, kNotNow);
    model_ = *after;
  }
  return {request.begin(), request.begin() + 6};
}

void Plant::tick() {
  const std::scoped_lock lock(mutex_);
  catch_up();
}

void Plant::set_reply_fault(const ReplyFault& reply_fault) {
  const std::scoped_lock lock(mutex_);
  fault_ = reply_fault;
}

void Plant::press(Action::Input input, bool pressed) {
  const std::scoped_lock lock(mutex_);
  catch_up();
  switch (input) {
    case Action::Input::kStopButton:
      inputs_.stop_button = pressed;
      break;
    case Action::Input::kPositiveEnd:
      inputs_.positive_end = pressed;
      break;
    case Action::Input::kNegativeEnd:
      inputs_.negative_end = pressed;
      break;
    case Action::Input::kStall:
      inputs_.stalled = pressed;
      break;
    case Action::Input::kFreeze:
      inputs_.frozen = pressed;
      break;
    case Action::Input::kDeaf:
      inputs_.deaf = pressed;
      break;
    case Action::Input::kRunaway:
      inputs_.runaway = pressed;
      break;
    case Action::Input::kDrift:
      inputs_.drifting = pressed;
      break;
  }
}

void Plant::clear() {
  const std::scoped_lock lock(mutex_);
  catch_up();
  inputs_ = {};
  fault_.count = 0;
}

void Plant::power_off() {
  const std::scoped_lock lock(mutex_);
  catch_up();
  powered_ = false;
  if (const auto braking =
          execute(machine_, model_, inputs_, {drive::Command::kDisable, 0, 0, 0})) {
    model_ = *braking;
  }
}

void Plant::power_on() {
  const std::scoped_lock lock(mutex_);
  catch_up();
  powered_ = true;
  const double now_s = model_.time_s;
  model_ = switched_on(model_.actual.x_mm);
  model_.time_s = model_.heard_s = now_s;
}

Plant::Place Plant::place() {
  const std::scoped_lock lock(mutex_);
  catch_up();
  return {model_.time_s, model_.actual.x_mm};
}

std::string Plant::state_json() {
  const std::scoped_lock lock(mutex_);
  catch_up();
  const Kinematics axis = feedback(model_, inputs_);
  const nlohmann::ordered_json out = {{"time_s", model_.time_s},
                                      {"position_mm", model_.actual.x_mm},
                                      {"velocity_mm_per_s", model_.actual.v_mm_per_s},
                                      {"demand_mm", model_.demand.x_mm},
                                      {"told_position_mm", axis.x_mm},
                                      {"told_velocity_mm_per_s", axis.v_mm_per_s},
                                      {"mode", kModes.at(static_cast<std::size_t>(model_.mode))},
                                      {"powered", powered_},
                                      {"enabled", model_.enabled()},
                                      {"homed", model_.homed},
                                      {"moving", model_.moving()},
                                      {"rested_s", model_.rested_s},
                                      {"alarm_code", model_.alarm},
                                      {"positive_end", at_positive_end(machine_, model_, inputs_)},
                                      {"negative_end", at_negative_end(machine_, model_, inputs_)},
                                      {"home_switch", at_home_switch(model_)},
                                      {"stop_button", inputs_.stop_button},
                                      {"stalled", inputs_.stalled},
                                      {"frozen", inputs_.frozen},
                                      {"deaf", inputs_.deaf},
                                      {"runaway", inputs_.runaway},
                                      {"drifting", inputs_.drifting},
                                      {"watchdog_s", machine_.watchdog_s},
                                      {"requests", requests_}};
  return out.dump();
}

}  // namespace hydroprint::simulated_drive
