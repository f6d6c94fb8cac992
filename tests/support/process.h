#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace hydroprint::testing {

/// How a program ended and what it said.
struct Ended {
  int status = -1;  ///< exit status; -1 if a signal ended it
  int signal = 0;
  std::string out, err;
  double seconds = 0;
};

struct ProcessOptions {
  std::vector<std::pair<__rlimit_resource_t, rlim_t>> limits;
  bool close_stdout = false;
  /// Files that the program finds open for writing, by their numbers.
  std::vector<std::pair<int, std::filesystem::path>> files;
  /// Descriptors of this process that it inherits: {its number, ours}.
  std::vector<std::pair<int, int>> inherited;
};

/// A program of ours, run as users run it; killed if the test forgets it.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments, const ProcessOptions& options = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const;
  [[nodiscard]] bool running();
  /// Waits for its end.
  Ended wait();

 private:
  TemporaryFolder folder_;
  pid_t pid_ = -1;
  double start_s_ = 0;
  std::optional<int> wait_status_;
};

/// Runs a program to its end.
Ended run(std::vector<std::string> arguments, const ProcessOptions& options = {});

}  // namespace hydroprint::testing
