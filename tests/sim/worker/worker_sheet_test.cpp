// The sheet and its ink.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/sim/worker/worker_fixture.h"

namespace hydroprint::worker {
namespace {

TEST_F(Worker, InkPassesAreReportedWithHowFarTheyMovedTheFilm) {
  ASSERT_EQ(testing::run(
                simulate({"--texture", path("texture.png"), "--ink-passes", "2", "--dpi", "600"}))
                .status,
            0);
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["parameters"]["model"], "sheet");
  EXPECT_EQ(report["parameters"]["ink_passes"], 2);
  const auto& passes = report["ink_passes"];
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_GT(passes[0]["moved_rms_mm"], 0);
  EXPECT_LT(passes[1]["moved_rms_mm"], 0.2 * passes[0]["moved_rms_mm"].get<double>());
}

TEST_F(Worker, InkGivenDirectlyTakesThePlaceOfPasses) {
  ASSERT_EQ(testing::run(simulate({"--ink-image", path("texture.png")})).status, 0);
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["parameters"]["ink_passes"], 0);
  EXPECT_TRUE(report["ink_passes"].empty());
  const auto& inputs = report["inputs"];
  EXPECT_TRUE(std::any_of(inputs.begin(), inputs.end(),
                          [](const auto& input) { return input["role"] == "ink_image"; }));
}

TEST_F(Worker, StokesKnowsNoInkAndSaysThatItKnowsNoDrag) {
  folder.write("film.toml", "drag_length_mm = 5\n");
  ASSERT_EQ(testing::run(simulate({"--model", "stokes", "--profile", path("film.toml")})).status,
            0);
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["parameters"]["model"], "stokes");
  EXPECT_EQ(report["parameters"]["ink_passes"], 0);
  const auto& warnings = report["warnings"];
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(),
                          [](const auto& warning) { return warning["code"] == "drag_ignored"; }));
}

}  // namespace
}  // namespace hydroprint::worker
