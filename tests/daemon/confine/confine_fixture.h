#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "daemon/confine/landlock.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace hydroprint::testing {

using Words = std::vector<std::string>;

/// Runs hydroprint-confine.
inline Ended confine(Words arguments, const ProcessOptions& options = {}) {
  arguments.insert(arguments.begin(), program_path("hydroprint-confine"));
  return run(std::move(arguments), options);
}

inline bool kernel_has_landlock() { return hydroprint::confine::landlock_version() > 0; }

inline constexpr const char* kAllow = "--allow-without-landlock";

/// hydroprint-confine with two folders.
class Confine : public ::testing::Test {
 protected:
  Confine() {
    std::filesystem::create_directory(inputs);
    std::filesystem::create_directory(work);
  }

  /// Runs a command with these folders and further flags, also if this kernel has no Landlock.
  [[nodiscard]] Ended run_confined(const Words& command, const Words& flags = {},
                                   const ProcessOptions& options = {}) const {
    Words all{"--inputs", inputs, "--work", work, "--memory-mib", "64"};
    if (!kernel_has_landlock()) all.emplace_back(kAllow);
    all.insert(all.end(), flags.begin(), flags.end());
    all.emplace_back("--");
    all.insert(all.end(), command.begin(), command.end());
    return confine(all, options);
  }
  /// Runs actions of the probe, and returns what it printed.
  [[nodiscard]] std::string probe(Words actions, const Words& flags = {}) const {
    actions.insert(actions.begin(), program_path("daemon_confine_probe"));
    const Ended ended = run_confined(actions, flags);
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    return ended.out;
  }

  TemporaryFolder folder;
  const std::string inputs = folder.path() / "in", work = folder.path() / "work";
};

}  // namespace hydroprint::testing
