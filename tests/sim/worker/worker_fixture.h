#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace hydroprint::worker {

using testing::Ended;
using testing::Process;
using testing::ProcessOptions;
using Arguments = std::vector<std::string>;

[[nodiscard]] std::string content(const std::filesystem::path& path);
[[nodiscard]] std::set<std::string> names_in(const std::filesystem::path& folder);

#ifdef __SANITIZE_ADDRESS__
constexpr bool kAddressSpaceIsOurs = false;  // the sanitizer itself maps terabytes
// With the sanitizer, the program lets libraries write to stderr, so that no report is lost.
constexpr bool kStderrIsOurs = false;
#else
constexpr bool kAddressSpaceIsOurs = true;
constexpr bool kStderrIsOurs = true;
#endif

/// The program from a user's point of view: a command line gives an artifact folder, one line and
/// an exit status. Runs in a folder with a small textured sphere.
class Worker : public ::testing::Test {
 protected:
  void SetUp() override;

  [[nodiscard]] std::string path(const std::string& name) const { return folder.path() / name; }
  [[nodiscard]] std::string out() const { return path("out"); }

  /// The command line of simulate on the sphere with a small film, unless `more` says otherwise.
  [[nodiscard]] Arguments simulate(const Arguments& more = {}, bool with_mesh = true) const;

  /// The command line of predict with film.png on the sphere with a small film.
  [[nodiscard]] Arguments predict(const Arguments& more) const;

  /// Runs the program and expects a failure as documented: this exit status, one line on stderr
  /// with all of the words, nothing on stdout, and an unchanged folder.
  void expect_refusal(int status, const Arguments& command, const Arguments& words,
                      const ProcessOptions& options = {}) const;

  testing::TemporaryFolder folder;
};

}  // namespace hydroprint::worker
