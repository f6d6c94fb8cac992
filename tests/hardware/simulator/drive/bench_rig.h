#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hardware/drive/drive.h"
#include "hardware/simulator/drive/drive_model.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::simulated_drive {

class VirtualRig;

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Options of a BenchRig.
struct BenchOptions {
  double start_mm = 50;
  int baud = 115200;
  std::string profile = HYDROPRINT_PROFILES "/virtual.toml";  ///< of the virtual rig
  std::optional<double> watchdog_s = {};
  std::optional<std::uint16_t> watchdog_action = {};
};

/// A virtual rig and the real client, connected over "tcp" or "rtu".
class BenchRig {
 public:
  explicit BenchRig(const std::string& wire, const BenchOptions& options = {});
  ~BenchRig();
  BenchRig(const BenchRig&) = delete;
  BenchRig& operator=(const BenchRig&) = delete;

  /// Connects, polls and enables the drive.
  void make_ready();

  /// Executes a line of the control socket.
  void act(const std::string& line);

  /// A number or Boolean (as 0 or 1) from the rig's true state.
  [[nodiscard]] double truth(const std::string& key);
  [[nodiscard]] std::string mode();

  /// Polls every 20 ms until `done` or for 5 s; returns the last state.
  drive::DriveState poll_until(const std::function<bool(const drive::DriveState&)>& done);

  /// Another link to the same drive.
  [[nodiscard]] std::unique_ptr<drive::Link> other_link(const drive::LinkTiming& timing) const;

  [[nodiscard]] drive::Drive& drive() { return *drive_; }
  [[nodiscard]] const drive::DriveProfile& profile() const { return drive_->profile(); }
  [[nodiscard]] const drive::Endpoint& endpoint() const { return drive_->link()->endpoint(); }

 private:
  testing::TemporaryFolder folder_;
  std::unique_ptr<VirtualRig> rig_;
  std::unique_ptr<drive::Drive> drive_;
};

/// Duration of a call in seconds.
template <class Call>
double seconds_of(const Call& call) {
  const auto start = Clock::now();
  call();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Fixture for TCP and RTU.
class OnBothWires : public ::testing::TestWithParam<const char*> {};

}  // namespace hydroprint::simulated_drive

/// Runs a test over TCP and over RTU.
#define HP_ON_BOTH_WIRES(suite)                                          \
  INSTANTIATE_TEST_SUITE_P(Wire, suite, ::testing::Values("tcp", "rtu"), \
                           [](const auto& wire) { return std::string(wire.param); })

/// Fails with the message of a Result or Status.
#define HP_ASSERT_OK(expression)                      \
  if (const auto& checked_ = (expression); !checked_) \
  GTEST_FAIL() << checked_.error().reason << ": " << checked_.error().message
