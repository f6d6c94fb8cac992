#include "daemon/platform/file_hashes.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <chrono>
#include <thread>

#include "sim/base/sha256.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

// Waits until a file that has just changed can be remembered.
void settle() { std::this_thread::sleep_for(std::chrono::milliseconds(80)); }

class FileHashesTest : public ::testing::Test {
 protected:
  hydroprint::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("a", "film");
  FileHashes hashes;
};

TEST_F(FileHashesTest, FileIsReadOnceUntilItChanges) {
  const auto is_read = [&] {
    bool was_asked = false;
    EXPECT_TRUE(hashes.of(file, [&] {
      was_asked = true;
      return false;
    }));
    return was_asked;
  };
  settle();
  EXPECT_TRUE(is_read());
  EXPECT_FALSE(is_read());
  std::filesystem::create_hard_link(file, folder.path() / "b");
  settle();
  EXPECT_TRUE(is_read()) << "a link changes the ctime";
  EXPECT_FALSE(is_read());
  settle();
  std::filesystem::rename(folder.write("c", "film"), file);
  EXPECT_TRUE(is_read()) << "another inode";
}

TEST_F(FileHashesTest, ChangeWithTheOldTimeIsNoticed) {
  settle();
  EXPECT_EQ(hashes.of(file).value(), sha256("film"));
  struct stat before {};
  ASSERT_EQ(::stat(file.c_str(), &before), 0);
  folder.write("a", "fill");
  const std::array times{before.st_atim, before.st_mtim};
  ASSERT_EQ(::utimensat(AT_FDCWD, file.c_str(), times.data(), 0), 0);
  EXPECT_EQ(hashes.of(file).value(), sha256("fill"));
}

TEST_F(FileHashesTest, CancelledReadingIsNotKept) {
  EXPECT_EQ(hashes.of(file, [] { return true; }).error().code, Code::kCancelled);
  EXPECT_EQ(hashes.of(file).value(), sha256("film"));
  EXPECT_FALSE(hashes.of(folder.path() / "none"));
}

}  // namespace
}  // namespace hydroprint::daemon
