// The sheet model, with the passes that determine its ink.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/sim/worker/artifact_files.h"
#include "tests/sim/worker/worker_fixture.h"

namespace hydroprint::worker {
namespace {

TEST_F(Worker, InkPassesAreReportedWithTheFilmsMoves) {
  ASSERT_EQ(testing::run(
                simulate({"--texture", path("texture.png"), "--ink-passes", "2", "--dpi", "600"}))
                .status,
            0);
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["parameters"]["model"], "MODEL_SHEET");
  EXPECT_EQ(report["parameters"]["ink_passes"], 2);
  const auto& passes = report["flow"]["ink_passes"];
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_GT(passes[0]["moved_rms_mm"], 0);
  EXPECT_LT(passes[1]["moved_rms_mm"], 0.2 * passes[0]["moved_rms_mm"].get<double>());
}

TEST_F(Worker, InkPassesEndWhenTheFilmMovesByLessThanAPixel) {
  constexpr double kPixel_mm = 25.4 / 50;
  ASSERT_EQ(
      testing::run(simulate({"--texture", path("texture.png"), "--ink-passes", "9", "--dpi", "50"}))
          .status,
      0);
  const auto passes = nlohmann::json::parse(content(out() + "/report.json"))["flow"]["ink_passes"];
  ASSERT_GE(passes.size(), 1u);
  EXPECT_LT(passes.size(), 9u);
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const bool is_last = i + 1 == passes.size();
    EXPECT_EQ(passes[i]["moved_p999_mm"] < kPixel_mm, is_last) << i;
  }
}

TEST_F(Worker, GivenInkReplacesPasses) {
  ASSERT_EQ(testing::run(simulate({"--ink-image", path("texture.png")})).status, 0);
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["parameters"]["ink_passes"], 0);
  EXPECT_TRUE(report["flow"]["ink_passes"].empty());
  const auto& inputs = report["run"]["inputs"];
  EXPECT_TRUE(std::any_of(inputs.begin(), inputs.end(),
                          [](const auto& input) { return input["role"] == "ink_image"; }));
}

TEST_F(Worker, StokesIgnoresInkAndWarnsThatItIgnoresDrag) {
  folder.write("film.toml", "drag_length_mm = 5\n");
  ASSERT_EQ(testing::run(simulate({"--model", "stokes", "--profile", path("film.toml")})).status,
            0);
  const auto report = nlohmann::json::parse(content(out() + "/report.json"));
  EXPECT_EQ(report["parameters"]["model"], "MODEL_STOKES");
  EXPECT_EQ(report["parameters"]["ink_passes"], 0);
  const auto& warnings = report["run"]["warnings"];
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(),
                          [](const auto& warning) { return warning["code"] == "DRAG_IGNORED"; }));
}

/// Maps of a dip to the equator through a film with ink.
class Inertia : public Worker {
 protected:
  [[nodiscard]] Arguments dip(Arguments more) const {
    more.insert(more.end(), {"--ink-image", path("texture.png"), "--depth-mm", "12"});
    more.insert(more.end(), {"--artifacts", "map"});
    return simulate(more);
  }
  [[nodiscard]] Ply map_of(const Arguments& more) const {
    const Ended ended = testing::run(dip(more));
    EXPECT_EQ(ended.status, 0) << ended.err;
    return read_ply(out() + "/surface_map.ply");
  }
};

/// Largest distance between the film points of a vertex in two maps.
double apart_mm(const Ply& a, const Ply& b) {
  EXPECT_EQ(a.vertices.size(), b.vertices.size());
  double most = 0;
  int count = 0;
  for (std::size_t v = 0; v < std::min(a.vertices.size(), b.vertices.size()); ++v) {
    const double apart = std::hypot(a.vertices[v][3] - b.vertices[v][3],  // film_x, film_y
                                    a.vertices[v][4] - b.vertices[v][4]);
    if (!std::isfinite(apart)) continue;
    most = std::max(most, apart);
    ++count;
  }
  EXPECT_GT(count, 200);
  return most;
}

TEST_F(Inertia, MatchesTheQuasistaticMapOnlyIfVolumeIsKept) {
  const Ply quasistatic = map_of({});
  const Ply inertial = map_of({"--inertia"});
  EXPECT_TRUE(nlohmann::json::parse(content(out() + "/report.json"))["parameters"]["inertia"]);
  // Down to the equator, a step of 0.01 mm displaces film by at most the share 0.01 / 12 of the
  // radius. The relative error of the velocity is less than half of that share, over a dip of 12 mm
  // (sim/sheet/README.md).
  const double bound_mm = 0.5 * 0.01 / 12 * 12;
  EXPECT_LT(apart_mm(inertial, quasistatic), bound_mm);
  // Other models and flags differ by more than this bound, so the comparison is meaningful.
  EXPECT_GT(apart_mm(map_of({"--model", "stokes"}), quasistatic), bound_mm);
  folder.write("film.toml", "poisson_ratio = 0.3\n");
  EXPECT_GT(apart_mm(map_of({"--inertia", "--profile", path("film.toml")}), quasistatic), bound_mm);
}

TEST_F(Inertia, IsRefusedWithStokes) {
  expect_refusal(2, dip({"--inertia", "--model", "stokes"}), {"--inertia: ", "model sheet"});
  expect_refusal(2, predict({"--inertia", "--model", "stokes"}), {"--inertia: ", "model sheet"});
}

}  // namespace
}  // namespace hydroprint::worker
