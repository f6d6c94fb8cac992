#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/daemon/api/support.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"
#include "tests/support/terminal.h"

namespace hydroprint::tests {

using Arguments = std::vector<std::string>;
using Outcome = hydroprint::testing::Ended;
using hydroprint::testing::Terminal;
using nlohmann::json;

const std::string kClient = testing::program_path("hydroprint");
constexpr char kPassword[] = "correct horse";

/// `hydroprint` with user accounts, and the real daemon.
class PeopleCli : public ::testing::Test {
 protected:
  static DaemonProcess::Options options() {
    DaemonProcess::Options options = DaemonProcess::fake();
    options.extra = "[people]\npassword_memory_mib = 1\npassword_passes = 1\n";
    return options;
  }

  /// A command line that runs `hydroprint` with the test's configuration folder, HYDROPRINT_SERVER
  /// and these variables ("NAME=VALUE").
  Arguments command(const Arguments& arguments, const Arguments& variables = {}) const {
    Arguments all{"/usr/bin/env", "-u", "HYDROPRINT_API_KEY",
                  "XDG_CONFIG_HOME=" + (folder_.path() / "config").string(),
                  "HYDROPRINT_SERVER=" + daemon_.address()};
    all.insert(all.end(), variables.begin(), variables.end());
    all.emplace_back(kClient);
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  }
  Outcome client(const Arguments& arguments, const Arguments& variables = {}) const {
    return hydroprint::testing::run(command(arguments, variables));
  }
  /// Runs `hydroprint` with these lines on standard input.
  Outcome told(const std::string& lines, const Arguments& arguments) const {
    Arguments all{"/bin/sh", "-c", "printf '%s' '" + lines + "' | \"$0\" \"$@\""};
    const Arguments rest = command(arguments);
    all.insert(all.end(), rest.begin(), rest.end());
    return hydroprint::testing::run(all);
  }
  json client_json(Arguments arguments, const Arguments& variables = {}) const {
    arguments.emplace_back("--json");
    const Outcome ended = client(arguments, variables);
    EXPECT_EQ(ended.status, 0) << ended.err;
    return json::parse(ended.out, nullptr, false);
  }
  void add(const std::string& name, const std::string& role) const {
    const Outcome ended =
        told(std::string(kPassword) + "\n", {"users", "add", name, "--role", role, "--password"});
    EXPECT_EQ(ended.status, 0) << ended.err;
  }
  void log_in(const std::string& name) const {
    const Outcome ended = told(std::string(kPassword) + "\n", {"login", "--user", name});
    EXPECT_EQ(ended.status, 0) << ended.err;
  }
  [[nodiscard]] std::filesystem::path credentials() const {
    return folder_.path() / "config" / "hydroprint" / "credentials.toml";
  }

  TemporaryFolder folder_;
  DaemonProcess daemon_{folder_.path(), options()};
};

}  // namespace hydroprint::tests
