// Progress, cancellation and failures during a run.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "tests/sim/worker/bodies.h"
#include "tests/sim/worker/worker_fixture.h"
#include "tests/support/paths.h"

namespace hydroprint::worker {
namespace {

namespace fs = std::filesystem;

TEST_F(Worker, ProgressOnAPipeRisesToTheEnd) {
  ProcessOptions options;
  options.files = {{5, folder.path() / "progress"}};
  ASSERT_EQ(
      testing::run(simulate({"--progress-fd", "5", "--texture", path("texture.png")}), options)
          .status,
      0);
  std::ifstream lines(path("progress"));
  double last = 0;
  std::set<std::string> stages;
  for (std::string line; std::getline(lines, line);) {
    const auto progress = nlohmann::json::parse(line);
    stages.insert(progress["stage"]);
    EXPECT_GE(progress["fraction"], 0);
    EXPECT_LE(progress["fraction"], 1);
    EXPECT_GE(progress["total_fraction"], last);
    EXPECT_TRUE(progress["eta_s"].is_null() || progress["eta_s"] >= 0);
    last = progress["total_fraction"];
  }
  EXPECT_EQ(last, 1);
  for (const char* stage : {"reading", "waterline", "velocity", "flow map", "film image"}) {
    EXPECT_TRUE(stages.count(stage)) << stage;
  }
}

TEST_F(Worker, AStalledOrClosedProgressReaderHasNoEffect) {
  std::array<int, 2> pipe_ends{};
  ASSERT_EQ(::pipe2(pipe_ends.data(), O_CLOEXEC), 0);
  ProcessOptions options;
  options.inherited = {{5, pipe_ends[1]}};
  // Nobody reads from the pipe, which is full from the start.
  ASSERT_EQ(::fcntl(pipe_ends[1], F_SETPIPE_SZ, 4096), 4096);
  const std::string filling(4096, ' ');
  ASSERT_EQ(::write(pipe_ends[1], filling.data(), filling.size()), 4096);
  EXPECT_EQ(testing::run(simulate({"--progress-fd", "5"}), options).status, 0);
  ::close(pipe_ends[0]);
  const Ended ended = testing::run(simulate({"--progress-fd", "5"}), options);
  EXPECT_EQ(ended.status, 0) << "signal " << ended.signal;
  ::close(pipe_ends[1]);
}

TEST_F(Worker, ProgressInAFileIsThatOfThePipe) {
  ProcessOptions options;
  options.files = {{5, folder.path() / "pipe"}};
  ASSERT_EQ(testing::run(simulate({"--progress-fd", "5"}), options).status, 0);
  ASSERT_EQ(testing::run(simulate({"--progress-file", path("file")})).status, 0);
  // Begin and end of each stage, without the time left. What comes between depends on the time.
  const auto ends_of_stages = [&](const char* name) {
    std::set<std::string> ends;
    std::ifstream lines(path(name));
    for (std::string line; std::getline(lines, line);) {
      auto progress = nlohmann::json::parse(line);
      progress.erase("eta_s");
      const double fraction = progress["fraction"];
      if (fraction == 0 || fraction == 1) ends.insert(progress.dump());
    }
    return ends;
  };
  EXPECT_GE(ends_of_stages("file").size(), 6u);
  EXPECT_EQ(ends_of_stages("file"), ends_of_stages("pipe"));
  EXPECT_TRUE(content(path("file")).ends_with("}\n"));
}

TEST_F(Worker, AProgressFileOnAFullDeviceHasNoEffect) {
  const Ended ended = testing::run(simulate({"--progress-file", "/dev/full"}));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err.find("/dev/full"), std::string::npos) << ended.err;
  EXPECT_TRUE(fs::exists(out() + "/film.png"));
}

TEST_F(Worker, AClosedStdoutIsHarmless) {
  ProcessOptions options;
  options.close_stdout = true;
  const Ended ended = testing::run(simulate({"--json"}), options);
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["run"]["verb"], "simulate")
      << "the summary must not be written into an artifact";
}

/// A run that was started and has reported progress. It takes half a minute of processor time if it
/// is not cancelled, so a busy machine cannot miss it.
class LongRun : public Worker {
 protected:
  void start() {
    folder.write("big.obj", sphere_obj(60, 300));
    ProcessOptions options;
    options.files = {{5, folder.path() / "progress"}};
    process.emplace(simulate({"--mesh", path("big.obj"), "--film", "A4", "--progress-fd", "5",
                              "--texture", path("texture.png"), "--ink-passes", "10"},
                             false),
                    options);
    const auto has_begun = [&] {
      return content(path("progress")).find("velocity") != std::string::npos;
    };
    ASSERT_TRUE(testing::wait_until([&] { return has_begun() || !process->running(); }, 300));
    ASSERT_TRUE(process->running()) << process->wait().err;
  }

  std::optional<Process> process;
};

TEST_F(LongRun, SigtermCancelsAndLeavesNothing) {
  start();
  process->signal(SIGTERM);
  const Ended ended = process->wait();
  EXPECT_EQ(ended.status, 130) << "signal " << ended.signal;
  EXPECT_EQ(ended.err, "hydroprint-worker: cancelled\n");
  EXPECT_EQ(names_in(folder.path()),
            (std::set<std::string>{"big.obj", "progress", "sphere.obj", "texture.png"}));
}

TEST_F(LongRun, SigintCancelsToo) {
  start();
  process->signal(SIGINT);
  EXPECT_EQ(process->wait().status, 130);
}

TEST_F(LongRun, KilledLeavesNoFolderOfThatName) {
  start();
  process->signal(SIGKILL);
  EXPECT_EQ(process->wait().signal, SIGKILL);
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Worker, OutOfMemoryIsAnOrdinaryErrorWithAdviceForTheVerb) {
  if (!kAddressSpaceIsOurs) GTEST_SKIP() << "address space cannot be limited";
  folder.write("big.obj", sphere_obj(60, 700, "0.2 0.6 0.4"));
  ProcessOptions options;
  options.limits = {{RLIMIT_AS, rlim_t{600} << 20}};
  const auto before = names_in(folder.path());
  const Ended ended =
      testing::run(simulate({"--mesh", path("big.obj"), "--film", "A4"}, false), options);
  EXPECT_EQ(ended.status, 4) << "signal " << ended.signal << " " << ended.err;
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_NE(ended.err.find("out of memory. Use a smaller model, a lower --dpi or more memory"),
            std::string::npos)
      << ended.err;
  EXPECT_EQ(names_in(folder.path()), before);
  options.limits = {{RLIMIT_AS, rlim_t{400} << 20}};
  const Ended page = testing::run({testing::program_path("hydroprint-worker"), "template", "--mesh",
                                   path("big.obj"), "--out", out()},
                                  options);
  EXPECT_NE(page.err.find("out of memory. Use a smaller model or more memory"), std::string::npos)
      << page.err;
}

}  // namespace
}  // namespace hydroprint::worker
