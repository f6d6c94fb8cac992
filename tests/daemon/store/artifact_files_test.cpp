// What a worker that was taken over may leave behind.
#include "daemon/store/artifact_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <functional>

#include "sim/base/sha256.h"
#include "tests/support/content.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

namespace fs = std::filesystem;
using testing::content;

constexpr std::int64_t kGiB = 1LL << 30;

class ArtifactFiles : public ::testing::Test {
 protected:
  ArtifactFiles() {
    for (const auto& path : {out, to.parent_path(), others}) fs::create_directories(path);
    std::ofstream(others / "key.pem") << "secret";
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(out / name) << text;
  }
  void write_sparse(const std::string& name, std::int64_t bytes) const {
    write(name, "");
    ASSERT_EQ(::truncate((out / name).c_str(), bytes), 0);
  }
  [[nodiscard]] Result<std::vector<Artifact>> publish(bool is_copied) const {
    PublishOptions all = options;
    all.within = runs;
    if (is_copied) all.copy = copy;
    return publish_artifacts(out, to, all);
  }
  // Neither way publishes or copies anything.
  void expect_refused(ErrorReason reason, const std::string& words) const {
    for (const bool is_copied : {false, true}) {
      const auto refused = publish(is_copied);
      ASSERT_FALSE(refused) << words;
      EXPECT_EQ(refused.error().reason, reason) << refused.error().message;
      EXPECT_NE(refused.error().message.find(words), std::string::npos) << refused.error().message;
      EXPECT_FALSE(fs::exists(to));
      EXPECT_FALSE(fs::exists(copy) && !fs::is_empty(copy));
      EXPECT_EQ(content(others / "key.pem"), "secret");
    }
  }

  testing::TemporaryFolder folder;
  const fs::path runs = folder.path() / "runs", work = runs / "7-1" / "work", out = work / "out";
  const fs::path to = folder.path() / "artifacts" / "7", copy = folder.path() / "7-1.output";
  const fs::path others = folder.path() / "others";
  PublishOptions options;
};

TEST_F(ArtifactFiles, AreMovedOrCopiedAndHashed) {
  for (const bool is_copied : {false, true}) {
    fs::remove_all(to);
    fs::create_directories(out);
    write("b.png", "film");
    write("a.json", std::string(3 << 20, 'x'));
    const auto artifacts = publish(is_copied);
    ASSERT_TRUE(artifacts) << artifacts.error().message;
    ASSERT_EQ(artifacts->size(), 2U);
    EXPECT_EQ(artifacts->front().name, "a.json");
    EXPECT_EQ(artifacts->front().size_bytes, 3 << 20);
    EXPECT_EQ(artifacts->front().sha256, sha256(std::string(3 << 20, 'x')));
    EXPECT_EQ(artifacts->back().media_type, "image/png");
    EXPECT_EQ(content(to / "a.json"), std::string(3 << 20, 'x'));
    EXPECT_EQ(content(to / "b.png"), "film");
    EXPECT_EQ(fs::exists(out), is_copied);
    EXPECT_FALSE(fs::exists(copy));
  }
}

TEST_F(ArtifactFiles, FoldersThatAreLinksAreNotFollowed) {
  fs::remove(out);
  expect_refused(ErrorReason::WORKER_UNUSABLE, "no artifacts");
  for (const fs::path& target : {others, fs::path("out"), folder.path() / "nowhere"}) {
    fs::create_directory_symlink(target, out);
    expect_refused(ErrorReason::WORKER_UNUSABLE, "a link or a file in place of its folder");
    fs::remove(out);
  }
  fs::create_directory(others / "out");
  std::ofstream(others / "out" / "film.png") << "film";
  for (const fs::path& exchanged : {work, work.parent_path()}) {
    fs::rename(exchanged, folder.path() / "aside");
    fs::create_directory_symlink(others, exchanged);
    expect_refused(ErrorReason::WORKER_UNUSABLE, "a link or a file in place of its folder");
    fs::remove(exchanged);
    fs::rename(folder.path() / "aside", exchanged);
  }
}

TEST_F(ArtifactFiles, OnlyRegularFilesWithOnePlainNameArePublished) {
  const auto odd = out / "odd.png";
  const std::vector<std::function<void()>> faults{
      [&] { fs::create_symlink(others / "key.pem", odd); },
      [&] { fs::create_symlink("nowhere", odd); },
      [&] { fs::create_hard_link(others / "key.pem", odd); },
      [&] { ASSERT_EQ(::mkfifo(odd.c_str(), 0600), 0); },
      [&] { fs::create_directory(odd); },
      [&] { write("odd\n.png", ""); },
  };
  for (const auto& fault : faults) {
    fs::remove_all(out);
    fs::create_directory(out);
    write("film.png", "film");
    fault();
    expect_refused(ErrorReason::WORKER_UNUSABLE, "other than regular files");
  }
}

TEST_F(ArtifactFiles, NumberIsLimited) {
  for (int i = 0; i < 1001; ++i) write(std::to_string(i), "");
  expect_refused(ErrorReason::WORKER_UNUSABLE, "too many files");
}

// Hashing them would take an hour.
TEST_F(ArtifactFiles, SizesAreLimitedBeforeAnythingIsRead) {
  for (int i = 0; i < 400; ++i) write_sparse(std::to_string(i), 4 * kGiB);
  expect_refused(ErrorReason::OUTPUT_LIMIT, "together are larger than 16384 MiB");
  options.limits.file_bytes = kGiB;
  expect_refused(ErrorReason::OUTPUT_LIMIT, "is larger than 1024 MiB");
}

TEST_F(ArtifactFiles, SparseFileThatDoesNotFitIsNotCopied) {
  const auto space = static_cast<std::int64_t>(fs::space(folder.path()).free);
  write_sparse("film.png", space + kGiB);
  options.limits = {2 * space + 2 * kGiB, 2 * space + 2 * kGiB};
  const auto refused = publish(true);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, ErrorReason::DISK_FULL) << refused.error().message;
  EXPECT_TRUE(fs::is_empty(copy));
}

TEST_F(ArtifactFiles, PublishingEndsAtItsDeadlineAndOnRequest) {
  EXPECT_EQ(publishing_time({kGiB, 20 * kGiB}), std::chrono::seconds(60 + 1024));
  write("film.png", "film");
  options.deadline = std::chrono::steady_clock::now();
  expect_refused(ErrorReason::TIME_LIMIT, "took too long");
  std::stop_source stop;
  stop.request_stop();
  options.stop = stop.get_token();
  EXPECT_EQ(publish(false).error().code, Code::kCancelled);
  options = {};
  EXPECT_TRUE(publish(false));
}

}  // namespace
}  // namespace hydroprint::daemon
