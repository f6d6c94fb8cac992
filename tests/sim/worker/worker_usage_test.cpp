// The command line itself: usage errors, help, and errors as JSON.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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
