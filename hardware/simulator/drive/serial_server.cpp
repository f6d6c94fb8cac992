#include "hardware/simulator/drive/serial_server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <modbus/modbus.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "hardware/drive/serial_line.h"
#include "sim/base/process/real_time_thread.h"

namespace hydroprint::simulated_drive {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kPollInterval_us = 20'000;
constexpr std::size_t kCrc = 2;
constexpr std::size_t kName = 128;

tl::unexpected<Error> refuse(const std::string& what) {
  return fail(Code::kFailedPrecondition,
              fmt::format("{} ({}). Use another path, or stop the program that uses it", what,
                          std::strerror(errno)));
}

void make_raw(int terminal) {
  termios settings{};
  ::tcgetattr(terminal, &settings);
  ::cfmakeraw(&settings);
  ::tcsetattr(terminal, TCSANOW, &settings);
}

}  // namespace

SerialServer::SerialServer(Plant& plant, const drive::Endpoint& line)
    : plant_(plant), line_(line), adu_(MODBUS_RTU_MAX_ADU_LENGTH) {}

Result<std::unique_ptr<SerialServer>> SerialServer::start(Plant& plant,
                                                          const drive::Endpoint& line) {
  std::unique_ptr<SerialServer> out(new SerialServer(plant, line));
  HP_RETURN_IF_ERROR(out->open());
  out->thread_ = std::thread([server = out.get()] { server->serve(); });
  return out;
}

SerialServer::~SerialServer() {
  ends_ = true;
  if (thread_.joinable()) thread_.join();
  if (modbus_ != nullptr) {
    modbus_free(modbus_);
    ::unlink(line_.device.c_str());
  }
  if (master_ >= 0) ::close(master_);
  if (slave_ >= 0) ::close(slave_);
}

Status SerialServer::open() {
  master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  std::array<char, kName> name{};
  if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
      ::ptsname_r(master_, name.data(), name.size()) != 0) {
    return refuse("no pseudo-terminal is available");
  }
  slave_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (slave_ < 0) return refuse(std::string(name.data()) + ": cannot be opened");
  make_raw(slave_);
  if (std::error_code error; std::filesystem::is_symlink(line_.device, error)) {
    ::unlink(line_.device.c_str());
  }
  if (::symlink(name.data(), line_.device.c_str()) != 0) {
    return refuse(line_.device + ": the link cannot be created");
  }
  modbus_ = modbus_new_rtu(name.data(), line_.baud, line_.parity, 8, line_.stop_bits);
  modbus_set_slave(modbus_, plant_.unit());
  modbus_set_socket(modbus_, master_);
  modbus_set_indication_timeout(modbus_, 0, kPollInterval_us);
  return {};
}

void SerialServer::serve() {
  (void)become_real_time(kDrivePriority);
  while (!ends_) {
    const int got = modbus_receive(modbus_, adu_.data());
    if (got > static_cast<int>(kCrc)) {
      reply_to(static_cast<std::size_t>(got));
    } else if (got < 0 && errno != ETIMEDOUT) {
      modbus_flush(modbus_);
    }
  }
}

void SerialServer::reply_to(std::size_t adu_bytes) {
  const auto begin = std::max(Clock::now(), free_at_);
  const auto request_end = begin + wire_time(line_, adu_bytes) + frame_gap(line_);
  std::this_thread::sleep_until(request_end);
  const Answer answer = plant_.answer(std::span(adu_).first(adu_bytes - kCrc));
  const ReplyFaultKind fault = answer.reply_fault.fault;
  const auto frame = overtaken_.bytes_for(serial_frame(answer.reply, fault), fault);
  const auto reply_end = request_end + answer.reply_fault.delay + wire_time(line_, frame.size());
  std::this_thread::sleep_until(reply_end);
  write_all(master_, frame);
  free_at_ = reply_end + frame_gap(line_);
}

}  // namespace hydroprint::simulated_drive
