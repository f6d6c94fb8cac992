#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/confine/sandbox.h"

namespace hydroprint::confine {

/// Options of hydroprint-confine.
struct Options {
  bool check = false;
  std::filesystem::path inputs, work;
  Limits limits;
  std::filesystem::path granted;     ///< empty: nothing is written
  std::vector<std::string> command;  ///< the program and its arguments
};

/// A parsed command line.
struct CommandLine {
  Options options;
  bool runs = false;  ///< false: print `text` and exit with `status`
  std::string text;   ///< help or version, or the error
  int status = 0;
};

/// Parses the command line. Arguments after the first "--" are the program's and stay unchanged.
[[nodiscard]] CommandLine parse_command_line(int argc, char** argv);

}  // namespace hydroprint::confine
