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
constexpr bool kStderrIsOurs = false;        // its reports must not be lost, nor is libraries' talk
#else
constexpr bool kAddressSpaceIsOurs = true;
constexpr bool kStderrIsOurs = true;
#endif

/// The program as its users see it: command line in, artifact folder, one line and exit status out;
/// run in a folder with a small textured sphere.
class Worker : public ::testing::Test {
 protected:
  void SetUp() override;

  [[nodiscard]] std::string path(const std::string& name) const { return folder.path() / name; }
  [[nodiscard]] std::string out() const { return path("out"); }

  /// simulate on the sphere with a small film, unless the flags say otherwise.
  [[nodiscard]] Arguments simulate(const Arguments& more = {}, bool with_mesh = true) const;

  /// predict of film.png on the sphere with a small film.
  [[nodiscard]] Arguments predict(const Arguments& more) const;

  /// Runs, and sees to it that it fails as promised: that status, one line that holds all of the
  /// words, nothing on stdout, and a folder as it was before.
  void expect_refusal(int status, const Arguments& command, const Arguments& words,
                      const ProcessOptions& options = {}) const;

  testing::TemporaryFolder folder;
};

}  // namespace hydroprint::worker
