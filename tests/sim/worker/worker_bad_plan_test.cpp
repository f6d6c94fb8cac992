// Plans that are refused.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sim/worker/plan_fixture.h"
#include "tests/support/paths.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kGood = R"({"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0]})";

std::string list_of(int dips) {
  std::string out;
  for (int i = 0; i < dips; ++i) out += (i == 0 ? "" : ", ") + std::string(kGood);
  return "[" + out + "]";
}

TEST_F(PlanWorker, BadImmersionsFilesAreRefusedByFileAndDip) {
  const std::string good = std::string("[") + kGood + ", ";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[]", "two.json: no dips. List at least one"},
      {list_of(13), "two.json: 13 dips. List at most 12"},
      {good + R"({"rotation_wxyz": [2, 0, 0, 0], "translation_mm": [0, 0, 0]}])",
       "two.json: dip 2: rotation_wxyz: the quaternion has length 2 instead of 1"},
      {good + R"({"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0], "depth_mm": -4}])",
       "two.json: dip 2: depth_mm: -4 is not a depth"},
      {"{", "two.json: "},
  };
  for (const auto& [json, words] : cases) {
    folder.write("two.json", json);
    expect_refusal(3, plan({}), {words});
  }
  expect_refusal(3, plan({"--immersions", path("none.json")}), {"none.json: no such file"});
}

TEST_F(PlanWorker, FilmThatTheSecondDipMissesNamesTheDip) {
  folder.write("two.json",
               std::string("[") + kGood +
                   R"(, {"rotation_wxyz": [0, 1, 0, 0], "translation_mm": [80, 0, 0]}])");
  expect_refusal(3, plan({}), {"--immersions: [1].pose: ", "film"});
}

TEST_F(PlanWorker, ModelWithoutColoursIsRefused) {
  folder.write("bare.obj",
               "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  folder.write("two.json", list_of(1));
  Arguments command = plan({"--mesh", path("bare.obj"), "--texture", ""});
  const auto texture = std::find(command.begin(), command.end(), "--texture");
  command.erase(texture, texture + 2);
  expect_refusal(3, command,
                 {"bare.obj: has no colour that was understood", "Name a picture", "paint"});
}

TEST_F(PlanWorker, MissingAndUnknownFlagsAreBadUsage) {
  Arguments command = plan({});
  const auto flag = std::find(command.begin(), command.end(), "--immersions");
  command.erase(flag, flag + 2);
  expect_refusal(2, command, {"--immersions is required"});
  expect_refusal(3, plan({"--blend-mm", "0"}), {"--blend-mm: 0 is out of range"});
  expect_refusal(2, plan({"--inertia"}), {"--inertia: "});
  expect_refusal(2, plan({"--pose", path("two.json")}), {"--pose"});
}

TEST_F(PlanWorker, BadSpecsAreRefusedByField) {
  const auto spec_with = [](const std::string& more) {
    return R"({"object": {"mesh": {"name": "sphere.obj"}, "texture": {"name": "texture.png"}}, )" +
           more + "}";
  };
  const std::string pose =
      R"("pose": {"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0]})";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"("dpi": 100)", "immersions: "},
      {R"("immersions": [{}, {"depth_mm": -1}])", "immersions[1].depth_mm: "},
      {R"("immersions": [{"pose": {"rotation_wxyz": [1, 1, 0, 0], "translation_mm": [0, 0, 0]}}])",
       "immersions[0].pose.rotation_wxyz: "},
      {R"("immersions": [{)" + pose + R"(}], "film": {"film": "5x5"})", "film.film: "},
      {R"("immersions": [{)" + pose + R"(}], "film": {"model": "MODEL_STOKES", "inertia": true})",
       "film.inertia: "},
      {R"("immersions": [{)" + pose + R"(}], "film": {"dip_speed_mm_per_s": 0})",
       "film.dip_speed_mm_per_s: "},
      {R"("immersions": [{)" + pose + R"(}], "film": {"profile": {"name": "no.toml"}})",
       "film.profile: "},
  };
  for (const auto& [more, field] : cases) {
    folder.write("spec.json", spec_with(more));
    expect_refusal(3,
                   {testing::program_path("hydroprint-worker"), "plan", "--out", out(), "--spec",
                    path("spec.json")},
                   {"spec.json: " + field});
  }
}

}  // namespace
}  // namespace hydroprint::worker
