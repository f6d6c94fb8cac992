#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/failure_note.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace hydroprint::testing {

struct VirtualRigOptions {
  double start_mm = 1;                                           ///< axis position at the start
  std::string wire = "tcp";                                      ///< "tcp" or "rtu"
  std::string profile = testing::drive_profile_path("virtual");  ///< profile of the simulated drive
  std::string scene = {};  ///< further lines of the scene file
  /// Names and contents of files that the scene uses.
  std::vector<std::pair<std::string, std::string>> files = {};
  std::vector<std::string> arguments = {};  ///< further arguments of the program
};

/// hydroprint-virtual-rig on a free loopback port or a pseudo-terminal. A failed test prints the
/// drive's true state.
class VirtualRig {
 public:
  /// Waits until the rig is ready. Throws if it does not start.
  explicit VirtualRig(const VirtualRigOptions& options = {});

  /// Sends lines to the control socket and returns the replies. Throws if the first reply is an
  /// error.
  std::string act(const std::string& lines) const;

  /// The true state of the drive, which may differ from the state that it reports.
  [[nodiscard]] nlohmann::json truth() const;
  [[nodiscard]] std::string mode() const { return truth().at("mode"); }
  [[nodiscard]] double position_mm() const { return truth().at("position_mm"); }
  [[nodiscard]] double speed_mm_per_s() const;
  /// Waits until the axis has this speed (0: is at rest); false after `seconds`.
  [[nodiscard]] bool gets_to(double speed_mm_per_s, double seconds = 10) const;
  /// Present time of the drive's own clock, in s. rested_s() uses the same clock.
  [[nodiscard]] double now_s() const { return truth().at("time_s"); }
  /// Waits for standstill and returns the time, on that clock, at which the axis came to rest.
  /// Throws if the axis keeps moving.
  [[nodiscard]] double rested_s() const;

  /// The drive's address: "tcp:127.0.0.1:40123" or "rtu:/tmp/...".
  [[nodiscard]] const std::string& address() const { return address_; }
  /// Section of a daemon's configuration file for this rig.
  [[nodiscard]] std::string section() const;
  [[nodiscard]] std::filesystem::path control() const { return folder() / "control"; }
  /// OpenNI2's name of the camera.
  [[nodiscard]] std::string camera() const { return "hydroprint:" + control().string(); }
  /// The folder of scene.toml and of the link to the pseudo-terminal, "drive".
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

  void signal(int number) const { process_.signal(number); }
  /// Sends SIGTERM and waits for the end.
  Ended stop();

 private:
  [[nodiscard]] std::string note() const;

  TemporaryFolder folder_;
  std::string profile_;
  Process process_;
  std::string address_;
  FailureNote note_{[this] { return note(); }};
};

}  // namespace hydroprint::testing
