// The installation's folder, which has the scripts of all jobs.
#include "daemon/workers/slurm/settings.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/workers/slurm/slurm_executor.h"
#include "tests/daemon/workers/slurm/scripted_engine.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon::slurm {
namespace {

class SlurmInstallation : public ::testing::Test {
 protected:
  SlurmInstallation() { std::filesystem::create_directory(settings.folder); }

  // Both the check and the start of the daemon refuse the folder, and write nothing to it.
  void expect_refused(const std::filesystem::path& named, const std::string& words) const {
    const Status checked = check_installation_folder(settings);
    const auto executor = SlurmExecutor::make(settings, {});
    ASSERT_FALSE(checked);
    ASSERT_FALSE(executor);
    EXPECT_EQ(checked.error().code, Code::kFailedPrecondition);
    EXPECT_TRUE(checked.error().message.starts_with(named.string() + ": "));
    EXPECT_NE(checked.error().message.find(words), std::string::npos) << checked.error().message;
    EXPECT_EQ(executor.error().message, checked.error().message);
    EXPECT_FALSE(std::filesystem::exists(lab / "lock"));
  }
  static void set_mode(const std::filesystem::path& path, mode_t mode) {
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
  }

  testing::TemporaryFolder folder;
  ScriptedEngine engine{folder.path() / "bin"};
  Settings settings{.folder = folder.path() / "shared", .installation = "lab"};
  const std::filesystem::path lab = installation_folder(settings);
};

TEST_F(SlurmInstallation, MissingFolderIsCreatedForTheDaemonAlone) {
  set_mode(settings.folder, 01777);
  EXPECT_TRUE(check_installation_folder(settings));
  EXPECT_FALSE(std::filesystem::exists(lab));
  ASSERT_TRUE(SlurmExecutor::make(settings, {}));
  EXPECT_EQ(std::filesystem::status(lab).permissions(), std::filesystem::perms::owner_all);
  EXPECT_TRUE(SlurmExecutor::make(settings, {})) << "again";
}

TEST_F(SlurmInstallation, LinkOrFileIsRefused) {
  std::filesystem::create_directory(folder.path() / "private");
  set_mode(folder.path() / "private", 0700);
  for (const char* const target : {"private", "nowhere"}) {
    std::filesystem::create_directory_symlink(folder.path() / target, lab);
    expect_refused(lab, "is not a folder, but a link or a file");
    std::filesystem::remove(lab);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "private"));
  std::ofstream(lab) << "x";
  expect_refused(lab, "choose another workers.slurm.installation");
}

TEST_F(SlurmInstallation, FolderOfAnotherUserIsRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root, to give a folder away";
  constexpr uid_t kOther = 54321;
  std::filesystem::create_directory(lab);
  set_mode(lab, 0777);
  set_mode(settings.folder, 01777);
  ASSERT_EQ(::chown(lab.c_str(), kOther, kOther), 0);
  expect_refused(lab, "belongs to 54321");
  set_mode(lab, 0700);
  expect_refused(lab, "belongs to 54321");
}

// As on a file system without modes, where chmod has no effect.
TEST_F(SlurmInstallation, FolderWithRightsOfOthersIsRefused) {
  std::filesystem::create_directory(lab);
  for (const mode_t mode : {0777, 0755, 0770, 0701}) {
    set_mode(lab, mode);
    expect_refused(lab,
                   "run chmod 0700 " + lab.string() + ", or use a file system that keeps modes");
  }
  set_mode(lab, 0700);
  EXPECT_TRUE(SlurmExecutor::make(settings, {}));
}

TEST_F(SlurmInstallation, SharedFolderInWhichAllCanReplaceItIsRefused) {
  set_mode(settings.folder, 0777);
  expect_refused(settings.folder, "chmod +t");
  set_mode(settings.folder, 01777);
  EXPECT_TRUE(SlurmExecutor::make(settings, {}));
}

}  // namespace
}  // namespace hydroprint::daemon::slurm
