// The verb plan: from a model and several poses to the films of all dips.

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hydroprint/v1/report.pb.h"
#include "sim/image/io/colour.h"
#include "sim/image/io/image_file.h"
#include "tests/sim/worker/bodies.h"
#include "tests/sim/worker/plan_fixture.h"

namespace hydroprint::worker {
namespace {

/// The levels of an image's pixels, from 0 to 255, channel by channel.
std::vector<int> levels(const std::string& path) {
  const auto read = image::read_image(path, {});
  EXPECT_TRUE(read) << path;
  std::vector<int> out;
  for (const image::Texel& texel : read->image.texels) {
    for (const int linear : {texel.r, texel.g, texel.b})
      out.push_back(image::srgb8_from_linear(static_cast<float>(linear) / 65535));
  }
  return out;
}

/// Expects plan.json to be the plan of the report, with what a later dip needs.
void expect_plan_file(const std::string& text, const v1::PlanReport& report) {
  v1::Plan plan;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(text, &plan).ok());
  EXPECT_EQ(plan.DebugString(), report.parameters().DebugString());
  EXPECT_EQ(plan.blend_mm(), 3);
  EXPECT_EQ(plan.film().film(), "60x70");
  EXPECT_EQ(plan.film().model(), v1::MODEL_STOKES);
  EXPECT_EQ(plan.film().dip_speed_mm_per_s(), 5);
  ASSERT_EQ(plan.immersions_size(), 2);
  // The sphere rests on the water at the start of each dip.
  for (const v1::DipSetup& dip : plan.immersions()) {
    EXPECT_NEAR(dip.pose().translation_mm(2), 12, 1e-9);
    EXPECT_FALSE(dip.has_depth_mm());
  }
  EXPECT_NEAR(std::abs(plan.immersions(1).pose().rotation_wxyz(1)), 1, 1e-12);
  const auto json = nlohmann::json::parse(text);
  EXPECT_TRUE(json.contains("mesh_sha256") && json["film"].contains("dip_speed_mm_per_s"))
      << "names in the files are those of the .proto file";
}

TEST_F(PlanWorker, TwoOppositeDipsShareASphere) {
  const v1::PlanReport report = planned({"--blend-mm", "3"});
  expect_plan_file(content(out() + "/plan.json"), report);
  std::set<std::string> expected = {"plan.json", "plan.ply", "report.json", "combined.png"};
  for (const char* name : {"stretch", "complete", "mask", "film"}) {
    for (const char* dip : {"-1.png", "-2.png"}) expected.insert(std::string(name) + dip);
  }
  EXPECT_EQ(names_in(out()), expected);
  expected.erase("report.json");
  EXPECT_EQ(std::set<std::string>(report.run().artifacts().begin(), report.run().artifacts().end()),
            expected);

  ASSERT_EQ(report.immersions_size(), 2);
  for (const v1::PlanReport::Dip& dip : report.immersions()) {
    EXPECT_NEAR(dip.share(), 0.5, 0.01);
    EXPECT_NEAR(dip.area_mm2(), 2 * std::numbers::pi * 12 * 12, 20);
    EXPECT_EQ(dip.pieces(), 1);
    EXPECT_NEAR(dip.depth_mm(), 24, 0.01);
    EXPECT_LT(dip.stretch().p50(), dip.stretch().p95());
    EXPECT_LT(dip.stretch().p95(), 3);
  }
  EXPECT_NEAR(report.seam_mm(), 2 * std::numbers::pi * 12, 2);
  EXPECT_EQ(report.unreached_share(), 0);
  EXPECT_GT(report.run().total_seconds(), 0);
  EXPECT_EQ(report.run().inputs(0).sha256(), report.parameters().mesh_sha256());
  EXPECT_EQ(report.run().inputs(2).role(), "immersions");
}

TEST_F(PlanWorker, PointsOfTheFileComeFirstWithWeightsThatSumToOne) {
  folder.write("ball.obj", sphere_obj(12, 8));  // coarser than 2 mm, so points are added
  const v1::PlanReport report = planned({"--mesh", path("ball.obj")});
  const PlanPly ply = read_plan_ply(out() + "/plan.ply", 2);
  ASSERT_EQ(ply.points.size(), static_cast<std::size_t>(report.mesh().surface_points()));
  ASSERT_GT(report.mesh().surface_points(), report.mesh().vertices());
  std::ifstream obj(path("ball.obj"));
  std::string v;
  int count = 0;
  for (double x = 0, y = 0, z = 0; obj >> v && v == "v" && obj >> x >> y >> z; ++count) {
    const PlanPoint& point = ply.points[static_cast<std::size_t>(count)];
    EXPECT_NEAR(std::hypot(point.xyz[0] - x, point.xyz[1] - y, point.xyz[2] - z), 0, 1e-4);
  }
  EXPECT_EQ(count, report.mesh().vertices());
  for (const PlanPoint& point : ply.points) {
    EXPECT_NEAR(point.weight[0] + point.weight[1], 1, 1e-6);
    if (std::abs(point.xyz[2]) > 0.3) {
      EXPECT_EQ(point.dip, point.xyz[2] < 0 ? 1 : 2);
    }
    if (point.xyz[2] < -6) {
      EXPECT_EQ(point.weight[0], 1) << "beyond the width of the blend";
    }
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(std::isnan(point.stretch_min[k]), std::isnan(point.stretch[k]));
      EXPECT_FALSE(point.stretch_min[k] > point.stretch[k]);
    }
    EXPECT_TRUE(point.dip == 0 ||
                std::isfinite(point.stretch[static_cast<std::size_t>(point.dip - 1)]));
  }
}

TEST_F(PlanWorker, FilmIsTheCompleteImageSeenThroughTheMask) {
  (void)planned({"--model", "sheet"});
  for (const char* dip : {"-1.png", "-2.png"}) {
    const auto read = [&](const char* name) { return levels(out() + "/" + name + dip); };
    const auto complete = read("complete"), mask = read("mask"), film = read("film");
    ASSERT_EQ(film.size(), complete.size());
    ASSERT_EQ(film.size(), mask.size());
    int printed = 0;
    for (std::size_t i = 0; i < film.size(); ++i) {
      const double weight = mask[i] / 255.0;
      ASSERT_NEAR(film[i], weight * complete[i] + (1 - weight) * 255, 0.51);
      printed += film[i] < 255 ? 1 : 0;
    }
    EXPECT_GT(printed, 1000);
  }
}

TEST_F(PlanWorker, OrientationGivenTwiceWarnsAndPrintsNothing) {
  write_immersions({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}});  // the third turns about z
  const v1::PlanReport report = planned({});
  EXPECT_TRUE(warned(report).contains("DIP_REPEATED dip 3"));
  EXPECT_TRUE(warned(report).contains("DIP_WITHOUT_REGION dip 3"));
  EXPECT_EQ(report.immersions(2).share(), 0);
  EXPECT_EQ(report.immersions(2).pieces(), 0);
  EXPECT_FALSE(report.immersions(2).stretch().has_p50());
  const auto film = levels(out() + "/film-3.png");
  EXPECT_TRUE(std::all_of(film.begin(), film.end(), [](int c) { return c == 255; }));
}

TEST_F(PlanWorker, CavityThatNoDipReachesIsToldWithItsShare) {
  folder.write("hollow.obj", hollow_sphere_obj(12, 6, 12));
  const v1::PlanReport report = planned({"--mesh", path("hollow.obj")});
  EXPECT_NEAR(report.unreached_share(), 0.2, 0.005);  // 6 mm and 12 mm: a quarter of the outer area
  EXPECT_TRUE(warned(report).contains("PARTS_NOT_REACHED surface"));
  const auto found =
      std::find_if(report.run().warnings().begin(), report.run().warnings().end(),
                   [](const auto& w) { return w.code() == v1::Warning::PARTS_NOT_REACHED; });
  ASSERT_NE(found, report.run().warnings().end());
  EXPECT_NE(found->message().find("20"), std::string::npos) << found->message();
}

TEST_F(PlanWorker, DipsOfDifferentDepthsLeaveABeltBare) {
  folder.write("two.json",
               R"([{"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0], "depth_mm": 8},
                   {"rotation_wxyz": [0, 1, 0, 0], "translation_mm": [0, 0, 0], "depth_mm": 8}])");
  const v1::PlanReport report = planned({});
  // Triangles of up to 2 mm are reached as a whole or not at all.
  EXPECT_GE(report.unreached_share(), 4.0 / 12);
  EXPECT_LE(report.unreached_share(), 6.0 / 12);
  EXPECT_TRUE(warned(report).contains("PARTS_NOT_REACHED surface"));
  EXPECT_EQ(report.parameters().immersions(0).depth_mm(), 8);
  for (const PlanPoint& point : read_plan_ply(out() + "/plan.ply", 2).points) {
    const bool reached = std::abs(point.xyz[2]) > 4.5;
    if (reached) {
      EXPECT_EQ(point.weight[point.xyz[2] < 0 ? 0 : 1], 1) << "one up to its end";
    }
    if (std::abs(point.xyz[2]) < 3) {
      EXPECT_EQ(point.dip, 0);
    }
  }
}

}  // namespace
}  // namespace hydroprint::worker
