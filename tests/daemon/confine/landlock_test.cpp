#include "daemon/confine/landlock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/landlock.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "tests/support/temporary_folder.h"

namespace hydroprint::confine {
namespace {

using Action = std::function<bool()>;

/// What the kernel's documentation says that each version knows.
struct Known {
  int version;
  std::uint64_t files, scoped;
};
constexpr Known kVersions[] = {
    {1, (1 << 13) - 1, 0}, {2, (1 << 14) - 1, 0}, {3, (1 << 15) - 1, 0}, {4, (1 << 15) - 1, 0},
    {5, (1 << 16) - 1, 0}, {6, (1 << 16) - 1, 3}, {7, (1 << 16) - 1, 3},
};

TEST(Landlock, DemandsOnlyWhatEachVersionKnows) {
  for (const auto& [version, files, scoped] : kVersions) {
    const LandlockRuleset rules = ruleset_of(version);
    EXPECT_EQ(rules.files & ~files, 0U) << version;
    EXPECT_EQ(rules.scoped & ~scoped, 0U) << version;
    EXPECT_EQ(rules.network, 0U) << version;
    const std::uint64_t all_of_first = kVersions[0].files & ~LANDLOCK_ACCESS_FS_EXECUTE;
    EXPECT_EQ(rules.files & all_of_first, all_of_first) << version;
  }
  EXPECT_NE(ruleset_of(3).files & 1 << 14, 0U) << "truncation";
  EXPECT_NE(ruleset_of(6).scoped & 2, 0U) << "signals";
  EXPECT_EQ(ruleset_of(99).files, ruleset_of(7).files);
}

/// The folders of a worker, which is restricted as by a kernel with an older version.
class OlderLandlock : public ::testing::TestWithParam<int> {
 protected:
  OlderLandlock() {
    for (const auto& path : {files.inputs, files.work, files.work / "a", files.work / "b"}) {
      std::filesystem::create_directory(path);
    }
    for (const auto& path : {secret, input, files.work / "a" / "moved"}) {
      EXPECT_GE(::close(::open(path.c_str(), O_WRONLY | O_CREAT, 0600)), 0);
    }
  }
  /// Returns whether an action succeeds in a restricted process.
  [[nodiscard]] bool can(const Action& action) const {
    constexpr int kNotRestricted = 2;
    const pid_t child = ::fork();
    if (child == 0) {
      const bool is_restricted =
          ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && restrict_files(files, GetParam());
      ::_exit(!is_restricted ? kNotRestricted : action() ? 0 : 1);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) != kNotRestricted) << status;
    return status == 0;
  }
  [[nodiscard]] bool can_open(const std::filesystem::path& path, int flags) const {
    return can([&] { return ::open(path.c_str(), flags, 0600) >= 0; });
  }

  hydroprint::testing::TemporaryFolder folder;
  const Files files{"/bin/true", folder.path() / "in", folder.path() / "work"};
  const std::filesystem::path secret = folder.path() / "secret", input = files.inputs / "model";
};

TEST_P(OlderLandlock, RestrictsFiles) {
  if (GetParam() > landlock_version()) GTEST_SKIP() << "this kernel has an older Landlock";
  EXPECT_TRUE(can_open(input, O_RDONLY));
  EXPECT_FALSE(can_open(input, O_WRONLY));
  EXPECT_TRUE(can_open(files.work / "new", O_RDWR | O_CREAT | O_TRUNC));
  EXPECT_TRUE(can_open(files.work / "new", O_RDWR | O_CREAT | O_TRUNC)) << "it exists";
  EXPECT_FALSE(can_open(secret, O_RDONLY));
  EXPECT_FALSE(can([&] { return ::unlink(secret.c_str()) == 0; }));
  const auto device = files.work / "device";
  EXPECT_FALSE(can([&] { return ::mknod(device.c_str(), S_IFCHR | 0600, makedev(1, 5)) == 0; }));
  EXPECT_TRUE(can_open("/dev/null", O_RDWR | O_TRUNC));
  EXPECT_TRUE(can_open("/dev/urandom", O_RDONLY));
  EXPECT_FALSE(can_open("/dev", O_RDONLY));
}

TEST_P(OlderLandlock, RestrictsWhatTheVersionKnows) {
  const int version = GetParam();
  if (version > landlock_version()) GTEST_SKIP() << "this kernel has an older Landlock";
  const auto from = files.work / "a" / "moved", to = files.work / "b" / "moved";
  EXPECT_EQ(can([&] { return ::rename(from.c_str(), to.c_str()) == 0; }), version >= 2);
  EXPECT_EQ(can_open(input, O_RDONLY | O_TRUNC), version < 3) << "then the filter refuses it";
  const pid_t parent = ::getpid();
  EXPECT_EQ(can([&] { return ::kill(parent, 0) == 0; }), version < 6);
  EXPECT_TRUE(can([] { return ::raise(0) == 0; }));
}

INSTANTIATE_TEST_SUITE_P(Versions, OlderLandlock, ::testing::Values(1, 2, 3, 4, 5, 6, 7));

TEST(FileFence, CoversOnlyTheSystemAndTheProgramsFolder) {
  const hydroprint::testing::TemporaryFolder folder;
  const auto program = folder.path() / "bin" / "worker";
  for (const std::filesystem::path file :
       {"/etc/hydroprint/key.pem", "/usr/key.pem", "/etc/../etc/key.pem"}) {
    EXPECT_TRUE(is_within_ruleset(file, program)) << file;
  }
  EXPECT_TRUE(is_within_ruleset(program.parent_path() / "key.pem", program));
  for (const std::filesystem::path& file :
       {folder.path() / "key.pem", std::filesystem::path("/etcetera/key.pem"),
        std::filesystem::path("/var/lib/hydroprint/tls/key.pem")}) {
    EXPECT_FALSE(is_within_ruleset(file, program)) << file;
  }
  std::filesystem::create_symlink("/etc/passwd", folder.path() / "link.pem");
  EXPECT_TRUE(is_within_ruleset(folder.path() / "link.pem", program));
}

}  // namespace
}  // namespace hydroprint::confine
