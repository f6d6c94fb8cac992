#pragma once

#include <chrono>
#include <memory>

#include "hardware/drive/drive.h"
#include "hardware/drive/profile.h"
#include "hardware/drive/transaction.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// Stops a drive from any thread, while another may be stuck in Drive: over a connection of its own
/// (TCP) or before everything else that waits for the line (RTU). Never polls, so that it does not
/// keep the drive's watchdog from seeing that the main thread is silent.
class StopLine {
 public:
  explicit StopLine(const Drive& drive);

  /// Connects ahead of time, so that stop() need not; harmless if it is connected.
  [[nodiscard]] Status connect();

  /// Tells the drive to stop, connecting and repeating (stopping twice does no harm) until the
  /// drive confirms or `patience` is over, which it outlasts by one request at most.
  /// Refuses with the last failure.
  [[nodiscard]] Status stop(std::chrono::milliseconds patience);

 private:
  DriveProfile profile_;
  std::shared_ptr<Link> link_;
};

}  // namespace hydroprint::drive
