#include "hardware/simulator/drive/scene.h"

#include <gtest/gtest.h>

#include "hardware/simulator/scene/rig_layout.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::simulated_drive {
namespace {

class SceneFile : public ::testing::Test {
 protected:
  Result<Scene> scene(const std::string& toml) {
    folder_.write("thing.obj", "v 0 0 0\n");
    return read_scene(folder_.write("scene.toml", toml));
  }
  testing::TemporaryFolder folder_;
};

TEST_F(SceneFile, AnEmptyFileHasNoObjectInTheGripper) {
  const auto read = scene("");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->mesh.empty());
  EXPECT_TRUE(read->X_GO.isApprox(Pose::Identity()));
  EXPECT_EQ(read->travel_mm, 300);
}

TEST_F(SceneFile, DescribesTheObjectAndItsPose) {
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

TEST_F(SceneFile, DescribesTheCamera) {
  const auto read = scene(
      "[film]\nsize_mm = [297, 420]\n[[marker]]\nname = \"right\"\noff_mm = [1, -2]\nturned_deg = "
      "90\n"
      "[camera]\nat_mm = [10, -300, 700]\nseed = 5\nclock = \"frames\"\nerrors = false\n"
      "[camera.sweep]\nvia_mm = [[1, 2, 600], [3, 4, 700]]\nperiod_s = 4\n");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_TRUE(read->camera);
  EXPECT_EQ(read->camera->seed, 5U);
  EXPECT_TRUE(read->camera->counts_frames);
  EXPECT_FALSE(read->camera->has_errors);
  EXPECT_TRUE(read->camera->stand.via_mm[1] == Eigen::Vector3d(3, 4, 700));
  EXPECT_EQ(read->camera->stand.period_s, 4);
  const auto nominal = simulated_scene::nominal_markers({297, 420});
  EXPECT_TRUE((read->markers[1].at_mm - nominal[1].at_mm).isApprox(Eigen::Vector3d(1, -2, 0)));
  EXPECT_NEAR(read->markers[1].turn_rad - nominal[1].turn_rad, M_PI / 2, 1e-12);
  EXPECT_TRUE(read->markers[0].at_mm == nominal[0].at_mm);
}

TEST_F(SceneFile, ObjectHangsInTheGripperAtItsTruePose) {
  folder_.write("plate.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\n");
  folder_.write("held.json", R"({"rotation_wxyz": [0, 1, 0, 0], "translation_mm": [1, 2, -40]})");
  const auto read =
      scene("[object]\nmesh = \"plate.obj\"\nscale = 2\npose = \"held.json\"\n[camera]\n");
  ASSERT_TRUE(read) << read.error().message;
  const auto scenery = scenery_of(*read);
  ASSERT_TRUE(scenery) << scenery.error().message;
  const simulated_scene::Body& object = scenery->bodies.back();
  EXPECT_TRUE(object.hangs);
  ASSERT_EQ(object.mesh.points.size(), 3U);
  EXPECT_TRUE(object.mesh.points[2].isApprox(Eigen::Vector3d(1, 2 - 20, -40)));
  EXPECT_EQ(scenery->markers.size(), 4U);
}

TEST_F(SceneFile, WithoutACameraThereIsNoScenery) {
  const auto scenery = scenery_of(*scene(""));
  ASSERT_FALSE(scenery);
  EXPECT_EQ(scenery.error().reason, ErrorReason::CAMERA_NOT_FOUND);
}

TEST_F(SceneFile, ErrorsNameFileLineAndRemedy) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[object]\nmesh = \"nothing.obj\"", "no such file. Check the path"},
      {"[object]\nmesh = \".\"", "not a regular file"},
      {"[object]\nscale = 2", "object.mesh is missing"},
      {"[object]\nmesh = \"thing.obj\"\npose = \"nothing.json\"", "no such file"},
      {"[object]\nmesh = \"thing.obj\"\npose = \"thing.obj\"", "not valid JSON"},
      {"[axis]\ntravel_mm = 5", "axis.travel_mm"},
      {"[axis]\nstart_mm = 301", "axis.start_mm"},
      {"[water]\nheight_mm = 5", "water.at_mm is missing"},
      {"[film]\nsize_mm = [210]", "film.size_mm is not a list of 2 numbers"},
      {"[[marker]]\nname = \"middle\"", "\"left\", \"right\", \"near\", \"far\""},
      {"[camera]\nat_mm = [0, 0, nan]", "camera.at_mm is not a list of 3 numbers"},
      {"[camera]\nat_mm = [0, 0, 0]", "is the camera's own position"},
      {"[camera.sweep]\nvia_mm = [[0, 0, 500], [0, 0, 0]]", "is the camera's own position"},
      {"[camera]\nclock = \"mine\"", "camera.clock has an unknown value"},
      {"[camera.sweep]\nperiod_s = 3", "camera.sweep.via_mm is missing"},
      {"[camera.sweep]\nvia_mm = [3]", "camera.sweep.via_mm is not a list"},
      {"[camera]\nnoise = 1", "noise is not a known key"}};
  for (const auto& [toml, what] : cases) {
    const auto read = scene(toml);
    ASSERT_FALSE(read) << toml;
    EXPECT_NE(read.error().message.find("scene.toml: line "), std::string::npos);
    EXPECT_NE(read.error().message.find(what), std::string::npos) << read.error().message;
  }
}

}  // namespace
}  // namespace hydroprint::simulated_drive
