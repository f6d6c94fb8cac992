#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "tests/sim/worker/bodies.h"
#include "tests/sim/worker/worker_fixture.h"

namespace hydroprint::worker {
namespace {

/// Returns an OBJ file without its texture coordinates.
std::string without_uvs(const std::string& obj) {
  const std::string lines = std::regex_replace(obj, std::regex("vt [^\n]*\n"), "");
  return std::regex_replace(lines, std::regex("/[0-9]+"), "");
}

/// Paints on a ball without texture coordinates and colours.
class PaintWorker : public Worker {
 protected:
  void SetUp() override {
    Worker::SetUp();
    folder.write("ball.obj", without_uvs(sphere_obj(12, 12)));
  }

  [[nodiscard]] Arguments ball(const Arguments& more) const {
    Arguments all = {"--mesh", path("ball.obj"), "--model", "stokes", "--ink-passes", "0"};
    all.insert(all.end(), more.begin(), more.end());
    return simulate(all, false);
  }

  /// The command line with a paint of this content.
  [[nodiscard]] Arguments painted(const std::string& json) const {
    folder.write("paint.json", json);
    return ball({"--paint", path("paint.json")});
  }
};

TEST_F(PaintWorker, ATextureNeedsNoTextureCoordinates) {
  const Ended ended = testing::run(ball({"--texture", path("texture.png")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.err.find("projected along the dip"), std::string::npos) << ended.err;
  const std::string report = content(folder.path() / "out" / "report.json");
  EXPECT_NE(report.find("\"PICTURE_PROJECTED\""), std::string::npos);
  EXPECT_NE(report.find("\"projection\": \"dip\""), std::string::npos) << report;
}

TEST_F(PaintWorker, ShortFormsAreAPaintOfOneLayer) {
  const Ended ended = testing::run(ball({"--texture", path("texture.png"), "--project", "box",
                                         "--project-size-mm", "20", "--project-turn-deg", "30"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  const std::string film = content(folder.path() / "out" / "film.png");
  const Ended same = testing::run(painted(
      R"({"layers": [{"picture": "texture.png", "projection": "box", "size_mm": 20, "turn_deg": 30}]})"));
  ASSERT_EQ(same.status, 0) << same.err;
  EXPECT_EQ(content(folder.path() / "out" / "film.png"), film);
  EXPECT_NE(film, "");
}

TEST_F(PaintWorker, BadPaintsAreRefusedByFileAndField) {
  const std::string layer = R"({"picture": "texture.png", "projection": "planar")";
  std::string nine;
  for (int i = 0; i < 9; ++i) nine += (i == 0 ? "" : ", ") + layer + "}";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"{\"layers\": [", "paint.json"},
      {"[]", "not a valid Paint"},
      {R"({"layer": []})", "layer"},
      {"{\"layers\": [" + nine + "]}", "layers: must have at most 8"},
      {"{\"layers\": [" + layer + R"(, "direction": [0, 0, 0]}]})", "layers[0].direction: has no"},
      {"{\"layers\": [" + layer + R"(, "up": [0, 0, 2]}]})", "layers[0].up: is parallel"},
      {"{\"layers\": [" + layer + R"(, "size_mm": 0}]})", "layers[0].size_mm"},
      {"{\"layers\": [" + layer + R"(, "size_mm": "NaN"}]})", "layers[0].size_mm"},
      {"{\"layers\": [" + layer + R"(, "opacity": 1.5}]})", "layers[0].opacity"},
      {"{\"layers\": [" + layer + R"(, "depth_mm": 5}]})", "layers[0].depth_mm: does not apply"},
      {"{\"layers\": [" + layer + R"(, "position_mm": [1, 2]}]})", "layers[0].position_mm"},
      {R"({"layers": [{"picture": "absent.png", "projection": "dip"}]})",
       "layers[0].picture: " + path("absent.png") + ": no such file"},
      {R"({"layers": [{"projection": "planar"}]})", "layers[0].picture: is missing"},
      {R"({"layers": [{"colour": "red"}]})", "layers[0].colour: must be"},
      {R"({"layers": [{"picture": "texture.png", "projection": "spherical"}]})",
       "layers[0].projection: must be"},
      {R"({"base_colour": "#12345g"})", "base_colour: must be"},
  };
  for (const auto& [json, words] : cases) {
    SCOPED_TRACE(json);
    expect_refusal(3, painted(json), {"paint.json", words});
  }
}

TEST_F(PaintWorker, PicturesThatAreNoneAreRefusedByName) {
  folder.write("words.png", "not a picture");
  folder.write("empty.png", "");
  for (const std::string name : {"words.png", "empty.png"}) {
    SCOPED_TRACE(name);
    expect_refusal(3, painted("{\"layers\": [{\"picture\": \"" + name + "\"}]}"), {name});
  }
}

TEST_F(PaintWorker, AWhitePaintIsRefused) {
  expect_refusal(3, painted("{}"), {"plain white"});
  expect_refusal(3, painted(R"({"layers": [{"colour": "#ffffff", "projection": "dip"}]})"),
                 {"plain white"});
}

TEST_F(PaintWorker, APaintReplacesTheTextureAndItsShortForms) {
  folder.write("paint.json", R"({"base_colour": "#ff0000"})");
  expect_refusal(2, ball({"--paint", path("paint.json"), "--texture", path("texture.png")}),
                 {"--texture: is replaced by paint"});
  expect_refusal(2, ball({"--project", "box"}), {"--project: needs a picture"});
  expect_refusal(2, ball({"--texture", path("texture.png"), "--project", "round"}),
                 {"--project: must be"});
  expect_refusal(
      2, ball({"--texture", path("texture.png"), "--project", "uv", "--project-size-mm", "3"}),
      {"--project-size-mm: does not apply to uv"});
  expect_refusal(3, ball({"--texture", path("texture.png"), "--project-size-mm", "0"}),
                 {"--project-size-mm: 0 is out of range"});
}

TEST_F(PaintWorker, ASpecHasThePaintWithItsFiles) {
  folder.write("spec.json", R"({"mesh": {"name": "ball.obj"}, "film": "60x70", "dpi": 100,
    "model": "MODEL_STOKES", "paint": {"layers": [
      {"picture": {"name": "texture.png"}, "projection": "cylindrical"},
      {"name": "eyes", "colour": "#000000", "projection": "decal", "position_mm": [0, 0, 500],
       "depth_mm": 1}]}})");
  const Arguments command = {testing::program_path("hydroprint-worker"),
                             "simulate",
                             "--spec",
                             path("spec.json"),
                             "--out",
                             out()};
  const Ended ended = testing::run(command);
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.err.find("layer \"eyes\" covers nothing"), std::string::npos) << ended.err;
  folder.write("spec.json", R"({"mesh": {"name": "ball.obj"}, "paint": {"layers": [
      {"picture": {"name": "absent.png"}, "projection": "box"}]}})");
  std::filesystem::remove_all(out());
  expect_refusal(3, command, {"paint.layers[0].picture", "absent.png"});
}

}  // namespace
}  // namespace hydroprint::worker
