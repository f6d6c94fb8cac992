#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/daemon/api/rig_support.h"

namespace hydroprint::tests {

/// A virtual rig, a daemon connected to it, and the client.
class RigPrograms {
 public:
  /// Waits until the daemon has connected to the rig.
  explicit RigPrograms(const DaemonProcess::Options& options = DaemonProcess::fake());

  /// Arguments that run `hydroprint` as this user, with a separate folder for the lease.
  [[nodiscard]] std::vector<std::string> command(const std::vector<std::string>& arguments,
                                                 const std::string& user = "tester") const;
  /// Runs the client to completion.
  hydroprint::testing::Ended client(const std::vector<std::string>& arguments,
                                    const std::string& user = "tester") const;
  /// Returns the output of --json. Fails the test unless the exit status is 0 and the output is one
  /// JSON value.
  [[nodiscard]] nlohmann::json client_json(std::vector<std::string> arguments,
                                           const std::string& user = "tester") const;
  /// Acquires the lease, arms, homes and moves to the position.
  void make_ready(double position_mm) const;
  [[nodiscard]] std::string state() const { return client_json({"rig", "status"}).at("state"); }
  /// The runtime folder (XDG_RUNTIME_DIR) of that user, which contains the lease.
  [[nodiscard]] std::filesystem::path runtime(const std::string& user = "tester") const;
  /// Waits until the axis moves (moves()) or is at rest (rests()).
  [[nodiscard]] bool moves() {
    return wait_until([&] { return rig.speed_mm_per_s() > 0; });
  }
  [[nodiscard]] bool rests() {
    return wait_until([&] { return rig.speed_mm_per_s() == 0; });
  }

  TemporaryFolder folder;
  VirtualRig rig;
  DaemonProcess daemon;
};

}  // namespace hydroprint::tests
