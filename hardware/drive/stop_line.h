#pragma once

#include <chrono>
#include <memory>

#include "hardware/drive/drive.h"
#include "hardware/drive/profile.h"
#include "hardware/drive/transaction.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// Stops a drive from any thread, even while another thread is blocked in Drive. Uses its own
/// connection (TCP) or takes precedence over all other requests on the line (RTU). It never polls,
/// so the drive's watchdog still detects a main thread that hangs.
class StopLine {
 public:
  explicit StopLine(const Drive& drive);

  /// Connects in advance, so that stop() does not have to. Does nothing if already connected.
  [[nodiscard]] Status connect();

  /// Sends stop to the drive, reconnecting and repeating (which is harmless) until the drive
  /// confirms or `patience` is over. May exceed `patience` by one request. Returns the last error.
  [[nodiscard]] Status stop(std::chrono::milliseconds patience);

 private:
  DriveProfile profile_;
  std::shared_ptr<Link> link_;
};

}  // namespace hydroprint::drive
