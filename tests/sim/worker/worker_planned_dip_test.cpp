// One dip of a plan at the pose that was measured: simulate --plan.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/sim/worker/bodies.h"
#include "tests/sim/worker/plan_fixture.h"
#include "tests/support/paths.h"

namespace hydroprint::worker {
namespace {

using nlohmann::json;

class PlannedDip : public PlanWorker {
 protected:
  void SetUp() override {
    PlanWorker::SetUp();
    (void)planned({"--blend-mm", "3"});
    std::filesystem::rename(out(), path("plan"));
  }

  [[nodiscard]] Arguments dip(int number, const Arguments& more = {}) const {
    Arguments all = {testing::program_path("hydroprint-worker"),
                     "simulate",
                     "--threads",
                     "2",
                     "--mesh",
                     path("sphere.obj"),
                     "--texture",
                     path("texture.png"),
                     "--plan",
                     path("plan"),
                     "--immersion",
                     std::to_string(number),
                     "--out",
                     out()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  /// Runs the dip and returns its report.
  [[nodiscard]] json dipped(int number, const Arguments& more = {}) const {
    const Ended ended = testing::run(dip(number, more));
    EXPECT_EQ(ended.status, 0) << ended.err;
    return ended.status == 0 ? json::parse(content(out() + "/report.json")) : json();
  }

  /// Writes a pose turned by an angle about x, from a dip that is upside down, and shifted in x.
  [[nodiscard]] std::string pose_file(double turned_deg, double shift_mm) const {
    const double half = (180 + turned_deg) / 2 * M_PI / 180;
    folder.write("hung.json",
                 fmt::format(R"({{"rotation_wxyz": [{}, {}, 0, 0], "translation_mm": [{}, 0, 0]}})",
                             std::cos(half), std::sin(half), shift_mm));
    return path("hung.json");
  }

  static std::set<std::string> codes(const json& report) {
    std::set<std::string> out;
    for (const json& warning : report["run"]["warnings"]) out.insert(warning["code"]);
    return out;
  }

  /// Replaces bytes of the plan's file and expects a refusal that names it.
  void expect_refused_plan(const std::string& file, const std::string& bytes,
                           const Arguments& words) {
    const std::string before = content(path("plan/" + file));
    folder.write("plan/" + file, bytes);
    expect_refusal(3, dip(1), words);
    folder.write("plan/" + file, before);
  }
};

TEST_F(PlannedDip, AtThePlannedPoseGivesThePlansFilm) {
  for (const int number : {1, 2}) {
    const json report = dipped(number);
    for (const char* name : {"film", "mask", "complete"}) {
      EXPECT_EQ(content(fmt::format("{}/{}.png", out(), name)),
                content(fmt::format("{}/{}-{}.png", path("plan"), name, number)))
          << name;
    }
    EXPECT_EQ(report["plan"]["immersion"], number);
    EXPECT_EQ(report["plan"]["immersions"], 2);
    EXPECT_EQ(report["plan"]["lost_share"], 0);
    EXPECT_EQ(report["parameters"]["dip"]["film"]["name"], "60x70") << "the plan's";
    EXPECT_EQ(report["parameters"]["model"], "MODEL_STOKES") << "the plan's";
    EXPECT_FALSE(codes(report).contains("PARTS_NOT_REACHED")) << "the other dip prints the rest";
    for (const std::string& code : codes(report)) EXPECT_FALSE(code.starts_with("PLAN_")) << code;
  }
  std::set<std::string> found = names_in(out());
  found.erase("wrinkles.png");
  const std::set<std::string> expected = {"complete.png", "error.png",   "film.png",
                                          "film_map.exr", "mask.png",    "predicted.png",
                                          "report.json",  "stretch.png", "surface_map.ply"};
  EXPECT_EQ(found, expected);
}

TEST_F(PlannedDip, DifferencesFromThePlanAreMeasuredAndWarnedOf) {
  const json near = dipped(2, {"--pose", pose_file(4, 3)});
  EXPECT_NEAR(near["plan"]["turn_deg"].get<double>(), 4, 1e-6);
  EXPECT_NEAR(near["plan"]["shift_mm"][0].get<double>(), 3, 1e-6);
  EXPECT_FALSE(codes(near).contains("PLAN_POSE_OFF"));
  const json turned = dipped(2, {"--pose", pose_file(6, 0)});
  EXPECT_TRUE(codes(turned).contains("PLAN_POSE_OFF"));
  EXPECT_TRUE(codes(dipped(2, {"--pose", pose_file(0, 11)})).contains("PLAN_POSE_OFF"));
  // Only one of the two dips is turned by 40 degrees, so the plane of equal stretch turns by 20: at
  // R = 12 mm, the seam moves by up to 4 mm.
  const json far = dipped(2, {"--pose", pose_file(40, 0)});
  EXPECT_NEAR(far["plan"]["seam_shift_mm"].get<double>(), 12 * std::sin(20 * M_PI / 180), 0.5);
  EXPECT_TRUE(codes(far).contains("PLAN_SEAM_MOVED"));
  const json shallow = dipped(2, {"--depth-mm", "6"});
  EXPECT_TRUE(codes(shallow).contains("PLAN_REACH_LOST"));
  // A cap of 6 mm has half the area of the half sphere of dip 2.
  EXPECT_NEAR(shallow["plan"]["lost_share"].get<double>(), 0.5, 0.1);
}

TEST_F(PlannedDip, AnotherMeshScaleOrFilmIsRefused) {
  folder.write("other.obj", sphere_obj(12, 9));
  Arguments other = dip(1);
  other[5] = path("other.obj");
  expect_refusal(3, other, {"other.obj: not the mesh of the plan"});
  expect_refusal(2, dip(1, {"--scale", "2"}), {"--scale: 2, but the plan has 1"});
  expect_refusal(2, dip(1, {"--film", "A4"}), {"--film: A4, but the plan has 60x70"});
}

TEST_F(PlannedDip, NumberOfADipThatThePlanDoesNotHaveIsRefused) {
  expect_refusal(3, dip(3), {"--immersion: 3, but the plan has 2 dips", "from 1 to 2"});
  expect_refusal(2, dip(0), {"--immersion: 0 is out of range"});
  Arguments none = dip(1);
  none.erase(none.begin() + 10, none.begin() + 12);
  expect_refusal(2, none, {"--immersion: missing"});
  none = dip(1);
  none.erase(none.begin() + 8, none.begin() + 10);
  expect_refusal(2, none, {"--immersion: needs a plan"});
}

TEST_F(PlannedDip, DamagedPlansAreRefused) {
  const std::string plan = content(path("plan/plan.json")), ply = content(path("plan/plan.ply"));
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  expect_refused_plan("plan.json", "{", {"plan.json: not a plan"});
  expect_refused_plan("plan.json", "[]", {"plan.json: not a plan"});
  expect_refused_plan("plan.json", "{}", {"plan.json: has 0 dips"});
  expect_refused_plan("plan.json", replaced(plan, "\"blend_mm\": 3", "\"blend_mm\": -3"),
                      {"plan.json: blend_mm"});
  const Arguments refused = {"plan.ply: not the plan.ply of a plan with 2 dips"};
  expect_refused_plan("plan.ply", "", refused);
  expect_refused_plan("plan.ply", ply.substr(0, ply.size() - 1), refused);
  expect_refused_plan("plan.ply", ply + "x", refused);
  expect_refused_plan("plan.ply", replaced(ply, "weight_2", "weight_3"), refused);
  const auto points = ply.find("element vertex ");
  expect_refused_plan(
      "plan.ply",
      ply.substr(0, points) + "element vertex 4000000000" + ply.substr(ply.find('\n', points)),
      refused);
  std::string wrong_index = ply;
  wrong_index[wrong_index.size() - 1] = '\x7f';
  expect_refused_plan("plan.ply", wrong_index, refused);
  std::string moved = ply;  // z of the first point, which is a pole
  moved[ply.find("end_header\n") + 11 + 16 + 6] ^= 0x10;
  expect_refused_plan("plan.ply", moved, {"plan.ply: "});
  std::filesystem::remove(path("plan/plan.ply"));
  expect_refusal(3, dip(1), {"plan.ply: no such file"});
}

}  // namespace
}  // namespace hydroprint::worker
