#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "hardware/drive/drive.h"
#include "hardware/simulator/drive/drive_model.h"
#include "tests/support/timing.h"
#include "tests/support/virtual_rig.h"

namespace hydroprint::simulated_drive {

using std::chrono::milliseconds;
using testing::Clock;
using testing::seconds_of;

/// A virtual rig and the real client, connected over "tcp" or "rtu".
class BenchRig : public testing::VirtualRig {
 public:
  /// By default, the axis starts at 50 mm, where it can move both ways.
  explicit BenchRig(const std::string& wire,
                    const testing::VirtualRigOptions& options = {.start_mm = 50});

  /// Connects, polls and enables the drive.
  void make_ready();

  /// Polls every 20 ms until `done` is true for the state; returns that state. Throws after 5 s.
  drive::DriveState poll_until(const std::function<bool(const drive::DriveState&)>& done);

  /// Another link to the same drive.
  [[nodiscard]] std::unique_ptr<drive::Link> other_link(const drive::LinkTiming& timing) const;

  [[nodiscard]] drive::Drive& drive() { return drive_; }
  [[nodiscard]] const drive::DriveProfile& profile() const { return drive_.profile(); }
  [[nodiscard]] const drive::Endpoint& endpoint() const { return drive_.link()->endpoint(); }

 private:
  drive::Drive drive_;
};

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
  GTEST_FAIL() << name_of(checked_.error().reason) << ": " << checked_.error().message
