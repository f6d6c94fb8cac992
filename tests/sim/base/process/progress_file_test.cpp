#include <gtest/gtest.h>
#include <signal.h>
#include <stdio.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "sim/base/process/progress.h"
#include "sim/base/process/progress_sinks.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::worker {
namespace {

ProgressReport at(const char* stage, double fraction) {
  return {stage, fraction, fraction, std::nullopt};
}

class ProgressFileTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(ProgressFile::create(path)); }

  [[nodiscard]] std::string content() const {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  testing::TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "progress";
  ProgressFile file{path};
};

/// The lines that ProgressPipe writes for the reports.
std::string lines_of_pipe(const std::filesystem::path& scratch,
                          const std::vector<ProgressReport>& reports) {
  std::FILE* const out = std::fopen(scratch.c_str(), "w");
  ProgressPipe pipe(::fileno(out));
  for (const ProgressReport& report : reports) pipe.write(report);
  std::fclose(out);
  std::ostringstream text;
  text << std::ifstream(scratch).rdbuf();
  return text.str();
}

TEST_F(ProgressFileTest, AnyNumberOfReportsIsOneAppendOfTheLinesOfThePipe) {
  // A reporter that is faster than Progress allows: ten seconds, a report per millisecond.
  std::vector<ProgressReport> reports;
  int appends = 0;
  std::string seen;
  for (int ms = 0; ms < 10'000; ++ms) {
    reports.push_back(at(ms < 5'000 ? "velocity" : "flow map", ms / 10'000.0));
    file.write(reports.back());
    if (ms % 250 == 249) file.append();
    if (std::filesystem::file_size(path) == seen.size()) continue;
    ++appends;
    const std::string now = content();
    ASSERT_TRUE(now.starts_with(seen)) << "what was read before must stay";
    ASSERT_EQ(now.back(), '\n');
    seen = now;
  }
  EXPECT_EQ(appends, 40);
  EXPECT_EQ(seen, lines_of_pipe(folder.path() / "pipe", reports));
}

TEST_F(ProgressFileTest, RepeatsTheLastLineWhileNothingIsReported) {
  for (int i = 0; i < 2 * ProgressFile::kRepeatAfter; ++i) file.append();
  EXPECT_EQ(content(), "") << "nothing to repeat";
  file.write(at("velocity", 0.25));
  file.write(at("velocity", 0.5));
  file.append();
  const std::string lines = content(), last = lines.substr(lines.find('\n') + 1);
  for (int i = 1; i < ProgressFile::kRepeatAfter; ++i) file.append();
  EXPECT_EQ(content(), lines);
  file.append();
  EXPECT_EQ(content(), lines + last);
  for (int i = 0; i < ProgressFile::kRepeatAfter; ++i) file.append();
  EXPECT_EQ(content(), lines + last + last);
}

TEST_F(ProgressFileTest, KeepsWhatTheFileContained) {
  folder.write("progress", "earlier\n");
  file.write(at("velocity", 0.5));
  file.append();
  EXPECT_TRUE(content().starts_with("earlier\n{\"stage\":\"velocity\",\"fraction\":0.5,"));
}

TEST_F(ProgressFileTest, ARemovedFileStaysRemoved) {
  std::filesystem::remove(path);
  file.write(at("velocity", 0.5));
  file.append();
  EXPECT_FALSE(std::filesystem::exists(path));
}

/// Limits the size of files that this process writes, like a disk without space.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t bytes) : handler_(::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }
  SizeLimit(const SizeLimit&) = delete;
  SizeLimit& operator=(const SizeLimit&) = delete;

 private:
  rlimit before_{};
  sighandler_t handler_;
};

TEST_F(ProgressFileTest, AFullDiskLeavesNoHalfLineAndLaterLinesFollow) {
  file.write(at("first", 0.25));
  file.append();
  const std::string first = content();
  {
    const SizeLimit limit(2 * first.size() + 10);  // two lines and a part of the third
    file.write(at("whole", 0.75));
    file.write(at("halved", 0.75));
    file.append();
    EXPECT_EQ(content().size(), 2 * first.size());
    file.write(at("lost", 0.75));
    file.write(at("lost too", 0.75));
    file.append();
  }
  file.write(at("after", 1));
  file.append();
  std::istringstream lines(content());
  std::string stages;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(line.starts_with("{\"stage\":\"") && line.ends_with("}")) << line;
    stages += line.substr(10, line.find('"', 10) - 10) + " ";
  }
  EXPECT_EQ(stages, "first whole after ");
}

TEST(ProgressFile, IsRefusedWhereItCannotBeCreated) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "missing" / "progress";
  const Status made = ProgressFile::create(path);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, Code::kInvalidArgument);
  EXPECT_TRUE(made.error().message.starts_with(path.string() + ": cannot be created"));
  EXPECT_FALSE(ProgressFile::create(folder.path())) << "a folder";
}

}  // namespace
}  // namespace hydroprint::worker
