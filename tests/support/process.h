#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/temporary_folder.h"
#include "tests/support/timing.h"

namespace hydroprint::testing {

/// Exit status and output of a program.
struct Ended {
  int status = -1;  ///< exit status; -1 if it was killed by a signal
  int signal = 0;
  std::string out, err;
  double seconds = 0;
};

struct ProcessOptions {
  std::vector<std::pair<__rlimit_resource_t, rlim_t>> limits;
  bool close_stdout = false;
  /// Files that the program finds open for appending: {descriptor, path}.
  std::vector<std::pair<int, std::filesystem::path>> files;
  /// Inherited descriptors: {descriptor in the program, descriptor in this process}.
  std::vector<std::pair<int, int>> inherited;
};

/// A running program of the project. The destructor kills it if it is still running.
class Process {
 public:
  explicit Process(std::vector<std::string> arguments, const ProcessOptions& options = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  void signal(int number) const;
  [[nodiscard]] bool running();
  /// Standard output of the program so far.
  [[nodiscard]] std::string out() const;
  /// Waits until the program has ended.
  Ended wait();

 private:
  TemporaryFolder folder_;
  pid_t pid_ = -1;
  Clock::time_point start_;
  std::optional<int> wait_status_;
};

/// Runs a program to its end.
Ended run(std::vector<std::string> arguments, const ProcessOptions& options = {});

}  // namespace hydroprint::testing
