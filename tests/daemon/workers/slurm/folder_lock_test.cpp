#include "daemon/workers/slurm/folder_lock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>

#include "tests/support/content.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon::slurm {
namespace {

using hydroprint::testing::content;

class SlurmFolderLock : public ::testing::Test {
 protected:
  // Makes the last heartbeat older, as the clock of the folder sees it.
  void age(std::int64_t seconds) const {
    struct stat info {};
    ASSERT_EQ(::stat(file.c_str(), &info), 0);
    const timespec past{info.st_mtim.tv_sec - seconds, 0};
    const timespec times[] = {past, past};
    ASSERT_EQ(::utimensat(AT_FDCWD, file.c_str(), times, 0), 0);
  }

  testing::TemporaryFolder folder;
  std::filesystem::path file = folder.path() / "lab" / "lock";
};

TEST_F(SlurmFolderLock, SecondDaemonIsRefusedWithTheHolder) {
  const auto first = FolderLock::take(file.parent_path());
  ASSERT_TRUE(first);
  const auto second = FolderLock::take(file.parent_path());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Code::kFailedPrecondition);
  EXPECT_NE(second.error().message.find("process " + std::to_string(::getpid())), std::string::npos)
      << second.error().message;
  EXPECT_TRUE(first->beat());
}

TEST_F(SlurmFolderLock, IsReleasedAtTheEnd) {
  { const auto first = FolderLock::take(file.parent_path()); }
  EXPECT_TRUE(FolderLock::take(file.parent_path()));
}

TEST_F(SlurmFolderLock, SilentHolderOfAnotherMachineLosesItAfter60Seconds) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << "elsewhere 1 boot:1 token\n";
  age(50);
  EXPECT_FALSE(FolderLock::take(file.parent_path()));
  age(15);
  EXPECT_TRUE(FolderLock::take(file.parent_path()));
}

// A clock that is an hour ahead or behind on one machine changes nothing: both times are the
// folder's. Here the folder's time itself jumps, which must not free a lock too early.
TEST_F(SlurmFolderLock, HeartbeatFromTheFutureIsRespected) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << "elsewhere 1 boot:1 token\n";
  age(-3600);
  EXPECT_FALSE(FolderLock::take(file.parent_path()));
}

TEST_F(SlurmFolderLock, KilledHolderOfThisMachineLosesItAtOnce) {
  const pid_t child = ::fork();
  if (child == 0) {
    const auto lock = FolderLock::take(file.parent_path());
    ::_exit(lock ? 0 : 1);  // without releasing it
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  ASSERT_TRUE(std::filesystem::exists(file));
  EXPECT_TRUE(FolderLock::take(file.parent_path()));
}

// Two containers, or two copies of a virtual machine, may have one host name.
TEST_F(SlurmFolderLock, HolderOfTheSameNameElsewhereIsNotTakenForEnded) {
  std::array<char, 256> host{};
  ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << host.data() << " 999999 otherboot/pid:[1] 77 token\n";
  EXPECT_FALSE(FolderLock::take(file.parent_path()));
}

TEST_F(SlurmFolderLock, LockThatIsNotUnderstoodIsRespectedUntilItIsSilent) {
  for (const char* words : {"", "\n", "one", "host notanumber x\n"}) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << words;
    EXPECT_FALSE(FolderLock::take(file.parent_path())) << words;
    age(61);
    EXPECT_TRUE(FolderLock::take(file.parent_path())) << words;
  }
}

TEST_F(SlurmFolderLock, HeartbeatRenewsIt) {
  const auto first = FolderLock::take(file.parent_path());
  age(70);
  EXPECT_TRUE(first->beat());
  EXPECT_FALSE(FolderLock::take(file.parent_path()));
}

TEST_F(SlurmFolderLock, LostLockIsNoticedAndNotReleased) {
  const auto others = std::string("elsewhere 1 boot:1 token\n");
  {
    const auto first = FolderLock::take(file.parent_path());
    std::ofstream(file) << others;
    EXPECT_FALSE(first->beat());
  }
  EXPECT_EQ(content(file), others);
}

TEST_F(SlurmFolderLock, FolderThatCannotBeWrittenIsNamed) {
  std::ofstream(folder.path() / "file") << "x";
  const auto lock = FolderLock::take(folder.path() / "file" / "lab");
  ASSERT_FALSE(lock);
  EXPECT_NE(lock.error().message.find("file"), std::string::npos) << lock.error().message;
}

TEST_F(SlurmFolderLock, NothingElseIsLeftInTheFolder) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << "elsewhere 1 boot:1 token\n";
  age(61);
  const auto lock = FolderLock::take(file.parent_path());
  const std::filesystem::directory_iterator entries(file.parent_path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

}  // namespace
}  // namespace hydroprint::daemon::slurm
