#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::capture {

/// Options of hydroprint-capture.
struct Options {
  std::string device;               ///< name of a camera in OpenNI2; empty: the first one
  std::filesystem::path recording;  ///< recording to read instead of a camera; empty: none
  std::filesystem::path record;     ///< file for a recording of the frames; empty: none
  std::filesystem::path out;
  std::optional<double> seconds;  ///< default: 2 for a camera, all of a recording
  double patience_s = 5;          ///< timeout for a frame and for the driver
  /// Writes pictures to stdout instead of frames to `out`, until the reader disconnects.
  bool live = false;
  double every_s = 1;  ///< interval between the pictures of `live`
  int progress_fd = -1;
  bool json = false;
};

/// Maximum duration of a capture, s: all frames are kept in memory until its end.
inline constexpr double kMostSeconds = 60;

/// The parsed options; if the program must not run, a text to print and an exit status.
struct CommandLine {
  Options options;
  bool runs = false;
  int status = 0;
  std::string text;  ///< for stdout if it is the help or the version, otherwise for stderr
};
[[nodiscard]] CommandLine parse_command_line(int argc, char** argv);

}  // namespace hydroprint::capture
