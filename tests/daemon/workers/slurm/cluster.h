#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/paths.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::tests {

/// A real Slurm of two nodes on loopback (tests/support/slurm), for this process and its daemons.
class Cluster {
 public:
  /// Message of a test that is skipped because Slurm is not installed; empty if it is.
  [[nodiscard]] static std::string missing() {
    const testing::Ended check = run({"check"});
    return check.status == 0 ? "" : "Slurm is not installed: " + check.out + check.err;
  }

  explicit Cluster(int cpus = 2) {
    call({"start", folder(), "--nodes", "2", "--cpus", std::to_string(cpus), "--while-pid",
          std::to_string(::getpid())});
    ::setenv("SLURM_CONF", (folder() + "/slurm.conf").c_str(), 1);
  }
  ~Cluster() {
    const testing::Ended stopped = run({"stop", folder()});
    EXPECT_EQ(stopped.status, 0) << stopped.err;
    ::unsetenv("SLURM_CONF");
  }
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  /// Does something (kill, restart, pause, resume) to a daemon: "slurmctld", "node1" or "node2".
  void does(const std::string& what, const std::string& daemon) const {
    call({what, folder(), daemon});
  }
  /// What a program of Slurm prints.
  [[nodiscard]] static std::string ask(std::vector<std::string> command) {
    return testing::run(std::move(command)).out;
  }

 private:
  [[nodiscard]] std::string folder() const { return folder_.path() / "slurm"; }
  static testing::Ended run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"/usr/bin/python3", "-B",
                                         testing::source_path("tests/support/slurm/slurm.py")});
    return testing::run(std::move(arguments));
  }
  static void call(std::vector<std::string> arguments) {
    const testing::Ended done = run(std::move(arguments));
    if (done.status != 0) throw std::runtime_error("slurm.py: " + done.err);
  }

  testing::TemporaryFolder folder_;
};

}  // namespace hydroprint::tests
