#include "daemon/platform/durable_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "tests/support/content.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

namespace fs = std::filesystem;

/// Allows few open files until the end of a test.
class FewDescriptors {
 public:
  FewDescriptors() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit few{64, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &few);
  }
  ~FewDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  FewDescriptors(const FewDescriptors&) = delete;
  FewDescriptors& operator=(const FewDescriptors&) = delete;

 private:
  rlimit before_{};
};

void make_deep_folder(const fs::path& path, int depth) {
  fs::create_directory(path);
  UniqueFd at = open_file(path, O_RDONLY | O_DIRECTORY).value();
  for (int i = 0; i < depth; ++i) {
    ASSERT_EQ(::mkdirat(at.get(), "d", 0700), 0);
    ASSERT_GE(UniqueFd(::openat(at.get(), "file", O_WRONLY | O_CREAT, 0600)).get(), 0);
    at = UniqueFd(::openat(at.get(), "d", O_RDONLY | O_DIRECTORY));
  }
}

TEST(Discard, DeletesFoldersOfAnyDepthWithFewDescriptors) {
  const testing::TemporaryFolder folder;
  const FewDescriptors few;
  make_deep_folder(folder.path() / "deep", 500);
  discard(folder.path() / "deep");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Discard, NamesInTheFolderAreNoObstacle) {
  const testing::TemporaryFolder folder;
  const auto top = folder.path() / "top";
  for (const char* name : {"discarded-1/file", "discarded-2", "a/b/c", "a/discarded-3/d"}) {
    fs::create_directories((top / name).parent_path());
    std::ofstream(top / name) << "x";
  }
  discard(top);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Discard, DeletesFoldersWithoutRights) {
  const testing::TemporaryFolder folder;
  const auto top = folder.path() / "top";
  fs::create_directories(top / "a" / "b");
  std::ofstream(top / "a" / "b" / "file") << "x";
  for (const auto& path : {top / "a" / "b", top / "a", top}) ASSERT_EQ(::chmod(path.c_str(), 0), 0);
  discard(top);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Discard, FollowsNoLink) {
  const testing::TemporaryFolder folder;
  const auto kept = folder.write("kept", "kept");
  fs::create_directories(folder.path() / "top" / "a");
  fs::create_directory_symlink(folder.path(), folder.path() / "top" / "a" / "link");
  fs::create_directory_symlink(folder.path(), folder.path() / "link");
  discard(folder.path() / "top");
  discard(folder.path() / "link");
  discard(folder.path() / "missing");
  EXPECT_EQ(testing::content(kept), "kept");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST(Discard, DeletesAFile) {
  const testing::TemporaryFolder folder;
  discard(folder.write("file", "x"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace hydroprint::daemon
