// The command line itself: usage errors, help, and errors as JSON.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "sim/base/sha256.h"
#include "tests/sim/worker/worker_fixture.h"
#include "tests/support/paths.h"

namespace hydroprint::worker {
namespace {

TEST_F(Worker, UsageErrorsEndWithStatusTwo) {
  const std::string worker = testing::program_path("hydroprint-worker");
  expect_refusal(2, {worker}, {"--help"});
  expect_refusal(2, {worker, "dance"}, {"--help"});
  expect_refusal(2, {worker, "simulate"}, {"required"});
  expect_refusal(2, {worker, "predict", "--mesh", path("sphere.obj"), "--out", out()},
                 {"--film-image"});
  for (const Arguments& flags : {Arguments{"--nonsense"},
                                 {"--dpi", "many"},
                                 {"--film", "A5"},
                                 {"--film", "circle:big"},
                                 {"--threads", "0"},
                                 {"--threads", "1.5"},
                                 {"--artifacts", "none"},
                                 {"--model", "honey"},
                                 {"--depth-mm", "deep"},
                                 {"--progress-fd", "77"},
                                 {"--progress-file", ""},
                                 {"--ink-passes", "-1"},
                                 {"--film-image", "x.png"}}) {
    SCOPED_TRACE(flags[0]);
    expect_refusal(2, simulate(flags), {flags[0]});
  }
  expect_refusal(2, simulate({"--progress-file", path("no folder") + "/progress"}),
                 {path("no folder") + "/progress: cannot be created"});
  expect_refusal(2, simulate({"--progress-file", path("progress"), "--progress-fd", "0"}),
                 {"--progress-file", "--progress-fd"});
}

TEST_F(Worker, HelpAndVersionGoToStdout) {
  const std::string worker = testing::program_path("hydroprint-worker");
  for (const Arguments& command :
       {Arguments{worker, "--help"}, {worker, "simulate", "--help"}, {worker, "predict", "-h"}}) {
    const Ended ended = testing::run(command);
    EXPECT_EQ(ended.status, 0);
    EXPECT_EQ(ended.err, "");
    EXPECT_NE(ended.out.find("Usage:"), std::string::npos);
  }
  EXPECT_TRUE(testing::run({worker, "--version"}).out.starts_with("hydroprint-worker 0."));
}

/// An installed worker: the program and its modules in a folder of their own.
class BuildId : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const std::string& name : names) {
      std::filesystem::copy_file(testing::program_path(name), folder.path() / name);
    }
  }

  [[nodiscard]] static std::string id_of(const std::string& program) {
    const Ended ended = testing::run({program, "--version", "--json"});
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(std::count(ended.out.begin(), ended.out.end(), '\n'), 1) << ended.out;
    const auto line = nlohmann::json::parse(ended.out);
    EXPECT_EQ("hydroprint-worker " + line["version"].get<std::string>() + "\n",
              testing::run({program, "--version"}).out);
    return line["build_id"];
  }

  [[nodiscard]] std::string id() const { return id_of(folder.path() / "hydroprint-worker"); }

  void add_byte_to(const std::string& name) const {
    std::ofstream(folder.path() / name, std::ios::app) << '\0';
  }

  testing::TemporaryFolder folder;
  std::vector<std::string> names = {"hydroprint-icp.so", "hydroprint-image-codecs.so",
                                    "hydroprint-worker"};
};

TEST_F(BuildId, IsTheSameInEveryFolderAndOfProgramAndModules) {
  const std::string original = id_of(testing::program_path("hydroprint-worker"));
  EXPECT_EQ(id(), original);
  std::string list;  // as sha256sum prints it
  for (const std::string& name : names) {
    list += sha256(content(folder.path() / name)) + "  " + name + "\n";
  }
  EXPECT_EQ(original, sha256(list));
  folder.write("README.md", "Beside the program.");
  EXPECT_EQ(id(), original);
  const std::string link = folder.path() / "link";
  std::filesystem::create_symlink("hydroprint-worker", link);
  EXPECT_EQ(id_of(link), original);
}

TEST_F(BuildId, ChangesWithEachFile) {
  std::set<std::string> ids = {id()};
  for (const std::string& name : names) {
    add_byte_to(name);
    EXPECT_TRUE(ids.insert(id()).second) << name;
  }
  std::filesystem::remove(folder.path() / "hydroprint-icp.so");
  EXPECT_TRUE(ids.insert(id()).second) << "a missing module";
}

TEST_F(Worker, ErrorsAreJsonOnRequest) {
  const Ended ended = testing::run(simulate({"--mesh", path("no.obj"), "--json"}, false));
  EXPECT_EQ(ended.status, 3);
  const auto error = nlohmann::json::parse(ended.out)["error"];
  EXPECT_EQ(error["code"], "NOT_FOUND");
  EXPECT_EQ(error["exit_status"], 3);
  EXPECT_EQ(std::string("hydroprint-worker: ") + error["message"].get<std::string>() + "\n",
            ended.err);
  const Ended usage = testing::run(simulate({"--dpi", "many", "--json"}));
  EXPECT_EQ(nlohmann::json::parse(usage.out)["error"]["exit_status"], 2);
}

}  // namespace
}  // namespace hydroprint::worker
