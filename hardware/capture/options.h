#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::capture {

/// Options of hydroprint-capture.
struct Options {
  std::string device;               ///< OpenNI2's name of a camera; empty: the first one
  std::filesystem::path recording;  ///< instead of a camera; empty: none
  std::filesystem::path record;     ///< file to record to; empty: none
  std::filesystem::path out;
  std::optional<double> seconds;  ///< default: 2 for a camera, all of a recording
  double patience_s = 5;          ///< timeout for a frame and for the driver
  /// Writes pictures to stdout instead of frames to `out`, until the reader disconnects.
  bool live = false;
  double every_s = 1;  ///< interval between these pictures
  int progress_fd = -1;
  bool json = false;
};

/// Longest capture, s: frames are kept in memory until the last one has arrived.
inline constexpr double kMostSeconds = 60;

/// The options, or a message and exit status if the program should not run.
struct CommandLine {
  Options options;
  bool runs = false;
  int status = 0;
  std::string text;  ///< to stdout for help and version, otherwise to stderr
};
[[nodiscard]] CommandLine parse_command_line(int argc, char** argv);

}  // namespace hydroprint::capture
