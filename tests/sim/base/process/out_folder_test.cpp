#include "sim/base/process/out_folder.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/content.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::worker {
namespace {

namespace fs = std::filesystem;
using testing::content;

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

/// Plans, creates and commits the folder `dir`, with report.json that contains `report`.
Status make(const fs::path& dir, const std::string& report) {
  HP_ASSIGN_OR_RETURN(OutFolder folder, OutFolder::plan(dir));
  HP_RETURN_IF_ERROR(folder.create());
  write(folder.partial() / "report.json", report);
  return folder.commit();
}

TEST(OutFolder, GetsItsNameOnlyWhenCommitted) {
  const testing::TemporaryFolder place;
  const fs::path dir = place.path() / "out";
  auto folder = OutFolder::plan(dir);
  ASSERT_TRUE(folder);
  ASSERT_TRUE(folder->create());
  write(folder->partial() / "report.json", "new");
  EXPECT_FALSE(fs::exists(dir));
  ASSERT_TRUE(folder->commit());
  EXPECT_EQ(content(dir / "report.json"), "new");
  EXPECT_EQ(entries(place.path()), 1u);
}

TEST(OutFolder, NothingIsLeftWithoutCommit) {
  const testing::TemporaryFolder place;
  {
    auto folder = OutFolder::plan(place.path() / "out");
    ASSERT_TRUE(folder && folder->create());
    write(folder->partial() / "film.png", "half");
  }
  EXPECT_EQ(entries(place.path()), 0u);
  auto abandoned = OutFolder::plan(place.path() / "out");
  ASSERT_TRUE(abandoned && abandoned->create());
  abandoned->abandon();
  EXPECT_EQ(entries(place.path()), 0u);
}

TEST(OutFolder, AnEarlierRunIsReplacedAsAWhole) {
  const testing::TemporaryFolder place;
  const fs::path dir = place.path() / "out";
  ASSERT_TRUE(make(dir, "old"));
  write(dir / "film.png", "old");
  ASSERT_TRUE(make(dir, "new"));
  EXPECT_EQ(content(dir / "report.json"), "new");
  EXPECT_FALSE(fs::exists(dir / "film.png"));
  EXPECT_EQ(entries(place.path()), 1u);
}

/// Lets a process die of SIGKILL when its artifact folder is half written.
void leave_half_of(const fs::path& dir) {
  const pid_t child = ::fork();
  if (child == 0) {
    auto folder = OutFolder::plan(dir);
    if (folder && folder->create()) {
      write(folder->partial() / "report.json", "half");
      write(folder->partial() / "film.png.part-77", "half");
      ::raise(SIGKILL);
    }
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
}

TEST(OutFolder, PartialFoldersOfKilledProcessesAreRemovedByTheNextRun) {
  const testing::TemporaryFolder place;
  leave_half_of(place.path() / "out");
  leave_half_of(place.path() / "other");
  EXPECT_EQ(entries(place.path()), 2u);
  ASSERT_TRUE(make(place.path() / "out", "new"));
  EXPECT_EQ(entries(place.path()), 2u) << "the partial folder of `other` must stay";
  ASSERT_TRUE(make(place.path() / "other", "new"));
  EXPECT_EQ(entries(place.path()), 2u);
  EXPECT_EQ(content(place.path() / "other" / "report.json"), "new");
}

TEST(OutFolder, FoldersOfLivingProcessesAndForeignFilesStay) {
  const testing::TemporaryFolder place;
  const fs::path dir = place.path() / "out";
  auto living = OutFolder::plan(dir);
  ASSERT_TRUE(living && living->create());
  write(living->partial() / "report.json", "living");
  const fs::path mine = place.path() / "out.partial-photos",
                 old = place.path() / "out.partial-abcdef-old";
  for (const fs::path& folder : {mine, old}) fs::create_directory(folder);
  write(mine / "me.png", "mine");
  write(old / "report.json", "of an earlier run, set aside");
  ASSERT_TRUE(make(dir, "first"));
  EXPECT_EQ(content(mine / "me.png"), "mine");
  EXPECT_TRUE(fs::exists(old / "report.json"));
  ASSERT_TRUE(living->commit());
  EXPECT_EQ(content(dir / "report.json"), "living");
}

TEST(OutFolder, AnEmptyFolderAndALinkToAFolderAreFilled) {
  const testing::TemporaryFolder place;
  const fs::path dir = place.path() / "out";
  fs::create_directory(dir);
  fs::create_directory_symlink(dir, place.path() / "link");
  ASSERT_TRUE(make(place.path() / "link/", "new"));
  EXPECT_TRUE(fs::is_symlink(place.path() / "link"));
  EXPECT_EQ(content(dir / "report.json"), "new");
}

TEST(OutFolder, ForeignFilesAreNeverReplaced) {
  const testing::TemporaryFolder place;
  const fs::path without_report = place.path() / "a";
  fs::create_directory(without_report);
  write(without_report / "film.png", "mine");
  const fs::path with_stranger = place.path() / "b";
  ASSERT_TRUE(make(with_stranger, "old"));
  write(with_stranger / "notes.txt", "mine");
  const fs::path file = place.write("c", "mine");
  for (const fs::path& dir : {without_report, with_stranger, file, place.path()}) {
    const Status status = make(dir, "new");
    ASSERT_FALSE(status) << dir;
    EXPECT_EQ(exit_status(status.error()), ExitStatus::kBadInput);
    EXPECT_NE(status.error().message.find(dir.string()), std::string::npos);
  }
  EXPECT_EQ(content(without_report / "film.png"), "mine");
  EXPECT_EQ(content(with_stranger / "notes.txt"), "mine");
  EXPECT_EQ(content(with_stranger / "report.json"), "old");
  EXPECT_EQ(content(file), "mine");
}

TEST(OutFolder, AMissingParentIsNamed) {
  const testing::TemporaryFolder place;
  const Status status = make(place.path() / "no" / "out", "new");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Code::kNotFound);
  EXPECT_NE(status.error().message.find((place.path() / "no").string() + ":"), std::string::npos);
}

}  // namespace
}  // namespace hydroprint::worker
