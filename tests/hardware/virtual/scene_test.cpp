#include "hardware/virtual/scene.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace hydroprint::virtual_rig {
namespace {

class SceneFile : public ::testing::Test {
 protected:
  Result<Scene> scene(const std::string& toml) {
    folder_.write("thing.obj", "v 0 0 0\n");
    return read_scene(folder_.write("scene.toml", toml));
  }
  testing::TemporaryFolder folder_;
};

TEST_F(SceneFile, EmptyOneHasNothingInTheGripper) {
  const auto read = scene("");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->mesh.empty());
  EXPECT_TRUE(read->X_GO.isApprox(Pose::Identity()));
  EXPECT_EQ(read->travel_mm, 300);
}

TEST_F(SceneFile, SaysWhatHangsThereAndHow) {
  folder_.write("held.json", R"({"rotation_wxyz": [0, 1, 0, 0], "translation_mm": [1, 2, -40]})");
  const auto read = scene(
      "[object]\nmesh = \"thing.obj\"\nscale = 10\npose = \"held.json\"\n"
      "[axis]\ntravel_mm = 120\nstart_mm = -2\n[water]\nat_mm = 90\n");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->mesh, folder_.path() / "thing.obj");
  EXPECT_EQ(read->scale, 10);
  EXPECT_TRUE((read->X_GO * Eigen::Vector3d(1, 1, 1)).isApprox(Eigen::Vector3d(2, 1, -41)));
  EXPECT_EQ(read->travel_mm, 120);
  EXPECT_EQ(read->start_mm, -2);
  EXPECT_EQ(read->water_mm, 90);
}

TEST_F(SceneFile, WhatIsWrongIsRefusedWithFileLineAndRemedy) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[object]\nmesh = \"nothing.obj\"", "no such file. Check the path"},
      {"[object]\nmesh = \".\"", "not a regular file"},
      {"[object]\nscale = 2", "object.mesh is missing"},
      {"[object]\nmesh = \"thing.obj\"\npose = \"nothing.json\"", "no such file"},
      {"[object]\nmesh = \"thing.obj\"\npose = \"thing.obj\"", "not valid JSON"},
      {"[axis]\ntravel_mm = 5", "axis.travel_mm"},
      {"[axis]\nstart_mm = 301", "axis.start_mm"},
      {"[water]\nheight_mm = 5", "water.at_mm is missing"},
      {"[camera]\nnoise = 1", "camera is not a known key"}};
  for (const auto& [toml, what] : cases) {
    const auto read = scene(toml);
    ASSERT_FALSE(read) << toml;
    EXPECT_NE(read.error().message.find("scene.toml: line "), std::string::npos);
    EXPECT_NE(read.error().message.find(what), std::string::npos) << read.error().message;
  }
}

}  // namespace
}  // namespace hydroprint::virtual_rig
