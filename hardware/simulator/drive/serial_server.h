#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "hardware/drive/transaction.h"
#include "hardware/simulator/drive/plant.h"
#include "hardware/simulator/drive/reply_bytes.h"

struct _modbus;

namespace hydroprint::simulated_drive {

/// Serves Modbus RTU on a pseudo-terminal, with the timing of a serial line. The destructor closes
/// the terminal; its users then get errors immediately, as when an adapter is unplugged.
class SerialServer {
 public:
  /// @param line  device: path of the symbolic link to the terminal (an existing link is replaced);
  ///              baud, parity and stop bits determine the timing
  [[nodiscard]] static Result<std::unique_ptr<SerialServer>> start(Plant& plant,
                                                                   const drive::Endpoint& line);
  ~SerialServer();
  SerialServer(const SerialServer&) = delete;
  SerialServer& operator=(const SerialServer&) = delete;

 private:
  SerialServer(Plant& plant, const drive::Endpoint& line);
  [[nodiscard]] Status open();
  void serve();
  void reply_to(std::size_t adu_bytes);

  Plant& plant_;
  drive::Endpoint line_;
  int master_ = -1;
  int slave_ = -1;  // kept open, because otherwise reading from the master fails
  _modbus* modbus_ = nullptr;
  std::vector<std::uint8_t> adu_;
  OvertakenReply overtaken_;
  // End of the silence that is required after the last reply.
  std::chrono::steady_clock::time_point free_at_;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace hydroprint::simulated_drive
