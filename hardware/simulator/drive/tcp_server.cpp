#include "hardware/simulator/drive/tcp_server.h"

#include <modbus/modbus.h>

#include <array>
#include <span>
#include <thread>

#include "hardware/simulator/drive/reply_bytes.h"
#include "sim/base/process/real_time_thread.h"

namespace hydroprint::simulated_drive {
namespace {

constexpr std::size_t kHeader = 6;

struct Free {
  void operator()(modbus_t* modbus) const { modbus_free(modbus); }
};

// libmodbus parses requests. Replies are built here, because a fault may require an incorrect one.
void serve(Plant& plant, int descriptor) {
  (void)become_real_time(kDrivePriority);
  const std::unique_ptr<modbus_t, Free> modbus(modbus_new_tcp("127.0.0.1", 0));
  modbus_set_socket(modbus.get(), descriptor);
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> adu{};
  OvertakenReply overtaken;
  for (;;) {
    const int got = modbus_receive(modbus.get(), adu.data());
    if (got < static_cast<int>(kHeader) + 2) return;
    const std::span<const std::uint8_t> query(adu.data(), static_cast<std::size_t>(got));
    const Answer answer = plant.answer(query.subspan(kHeader));
    if (answer.reply_fault.fault == ReplyFaultKind::kLate) {
      std::this_thread::sleep_for(answer.reply_fault.delay);
    }
    const ReplyFaultKind fault = answer.reply_fault.fault;
    const auto frame = tcp_frame(query.first(kHeader), answer.reply, fault);
    write_all(descriptor, overtaken.bytes_for(frame, fault));
  }
}

}  // namespace

Result<std::unique_ptr<SocketServer>> serve_tcp(Plant& plant, int port) {
  return SocketServer::tcp(port, [&plant](int descriptor) { serve(plant, descriptor); });
}

}  // namespace hydroprint::simulated_drive
