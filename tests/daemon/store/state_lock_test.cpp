// Modes and owner of the state folder.
#include "daemon/store/state_lock.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <map>

#include "daemon/platform/private_files.h"
#include "daemon/store/database/schema.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

namespace fs = std::filesystem;

mode_t mode_of(const fs::path& path) {
  struct stat info {};
  EXPECT_EQ(::stat(path.c_str(), &info), 0) << path;
  return info.st_mode & 0777;
}

class StateLock : public ::testing::Test {
 protected:
  hydroprint::testing::TemporaryFolder folder;
  Layout layout{folder.path() / "state"};
};

TEST_F(StateLock, ModesAreCorrectedAtTheStart) {
  ASSERT_TRUE(lock_state(layout));
  const auto database = open_store(layout.database()).value();
  ASSERT_TRUE(make_folder(layout.artifacts()));
  const std::map<fs::path, mode_t> changed{
      {layout.root, 0755},
      {layout.database(), 0666},
      {layout.database().string() + "-wal", 0644},
      {layout.artifacts(), 0711},
  };
  for (const auto& [path, mode] : changed) {
    ASSERT_EQ(::chmod(path.c_str(), mode), 0) << path;
    EXPECT_EQ(check_mode(path, 0700).error().code, Code::kFailedPrecondition) << path;
  }
  const Status corrected = correct_modes(layout);
  ASSERT_TRUE(corrected) << corrected.error().message;
  EXPECT_EQ(mode_of(layout.root), 0700U);
  EXPECT_EQ(mode_of(layout.database()), 0600U);
  EXPECT_EQ(mode_of(layout.database().string() + "-wal"), 0600U);
  EXPECT_EQ(mode_of(layout.artifacts()), 0700U);
  for (const auto& [path, mode] : changed) EXPECT_TRUE(check_mode(path, 0700)) << path;
}

TEST_F(StateLock, FolderAndFilesOfAnotherUserAreRefusedByName) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root, to change an owner";
  ASSERT_TRUE(lock_state(layout));
  ASSERT_TRUE(open_store(layout.database()));
  const auto expect_refused = [&](const fs::path& path, const Status& refused) {
    ASSERT_FALSE(refused) << path;
    EXPECT_EQ(refused.error().code, Code::kPermissionDenied);
    for (const std::string& part : {path.string() + ": belongs to nobody", std::string("chown")}) {
      EXPECT_NE(refused.error().message.find(part), std::string::npos) << refused.error().message;
    }
  };
  ASSERT_EQ(::chown(layout.database().c_str(), 65534, 65534), 0);
  expect_refused(layout.database(), correct_modes(layout));
  ASSERT_EQ(::chown(layout.root.c_str(), 65534, 65534), 0);
  expect_refused(layout.root, lock_state(layout).map([](const UniqueFd&) {}));
}

// As on vfat, which has no modes: files of proc do not take them either.
TEST_F(StateLock, FileSystemWithoutModesIsRefused) {
  const fs::path path = "/proc/self";
  if (!fs::exists(path)) GTEST_SKIP() << "needs /proc";
  const auto refused = set_mode(path, 0700);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::kFailedPrecondition);
  EXPECT_NE(refused.error().message.find("does not keep the mode 0700; mount it with umask=077"),
            std::string::npos)
      << refused.error().message;
}

}  // namespace
}  // namespace hydroprint::daemon
