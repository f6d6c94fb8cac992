#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::capture {

/// What hydroprint-capture is asked for.
struct Options {
  std::string device;               ///< OpenNI2's name of a camera; empty: the first there is
  std::filesystem::path recording;  ///< in place of a camera; empty: none
  std::filesystem::path record;     ///< where to record to; empty: nowhere
  std::filesystem::path out;
  std::optional<double> seconds;  ///< default: 2 of a camera, all of a recording
  double patience_s = 5;          ///< for a frame, and for a driver to do anything
  /// Pictures on stdout in place of frames in `out`, for as long as somebody wants them.
  bool live = false;
  double every_s = 1;  ///< from one of those to the next
  int progress_fd = -1;
  bool json = false;
};

/// Frames are kept in memory until the last has come: so many seconds at most.
inline constexpr double kMostSeconds = 60;

/// Options, or what to say in place of work and the exit status with it.
struct CommandLine {
  Options options;
  bool runs = false;
  int status = 0;
  std::string text;  ///< of help or version, for stdout; else for stderr
};
[[nodiscard]] CommandLine parse_command_line(int argc, char** argv);

}  // namespace hydroprint::capture
