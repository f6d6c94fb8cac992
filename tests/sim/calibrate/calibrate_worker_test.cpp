// The verb calibrate, with frames of the virtual camera.
#include <algorithm>

#include "sim/calibrate/camera_file.h"
#include "tests/sim/calibrate/calibrate_fixture.h"

namespace hydroprint::calibrate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ended;

TEST_F(Calibrate, NamesAHiddenMarker) {
  rig.states[2] = simulated_scene::MarkerState::kHidden;
  take_frames(4);
  registration::CameraCalibration camera;
  camera.lens = testing::lens_of(rig.lens);
  camera.views = 1;
  folder.write("camera.json", camera_json(camera));
  const Ended ended =
      calibrate({"--camera", path("camera.json"), "--gripper-mm", std::to_string(rig.gripper_mm)});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const json warnings = json::parse(ended.out).at("report").at("run").at("warnings");
  // The second warning says that the pose is not fully determined.
  ASSERT_EQ(warnings.size(), 2U) << warnings;
  EXPECT_EQ(warnings[0]["code"], "MARKER_LEFT_OUT");
  EXPECT_EQ(warnings[0]["where"]["marker"], "near");
}

TEST_F(Calibrate, WarnsOfAnUncalibratedCamera) {
  take_frames(4);
  // With the driver's lens, calibrate may fail because the markers disagree. The error must then
  // mention the camera's calibration.
  const Ended ended = calibrate({"--gripper-mm", std::to_string(rig.gripper_mm)});
  if (ended.status != 0) {
    EXPECT_NE(ended.err.find("calibrate the camera"), std::string::npos) << ended.err;
    return;
  }
  bool is_said = false;
  const json out = json::parse(ended.out);
  for (const auto& warning : out["report"]["run"]["warnings"])
    is_said = is_said || warning["code"] == "CAMERA_NOT_CALIBRATED";
  EXPECT_TRUE(is_said);
}

TEST_F(Calibrate, RefusesBadScansInOneLine) {
  const auto refusal = [&](const Ended& ended, const std::string& words) {
    EXPECT_EQ(ended.status, 3) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_FALSE(fs::exists(path("out")));
  };
  take_frames(2);
  refusal(calibrate({}, "nowhere"), "frames.json: no such file");
  folder.write("frames/frames.json", R"({"width": 640, "height": 480, "frames": []})");
  refusal(calibrate({}), "hydroprint-capture");
  folder.write("frames/frames.json",
               R"({"width": 640, "height": 480, "horizontal_fov_rad": 1, "vertical_fov_rad": 0.8,
                   "frames": [{"file": "../0.png"}]})");
  refusal(calibrate({}), "another folder");
  layout = path("layout.toml");
  folder.write("layout.toml", "[markers]\nwidth_mm = -3\n");
  refusal(calibrate({}), "layout.toml: line 2: markers.width_mm");
}

TEST_F(Calibrate, RefusesEmptyFrames) {
  write_frames(path("frames"),
               std::vector<scan::DepthFrame>(3, {640, 480, std::vector<float>(640 * 480)}));
  const Ended ended = calibrate({});
  EXPECT_EQ(ended.status, 3);
  EXPECT_EQ(json::parse(ended.out)["error"]["reason"], "CAMERA_BLACK");
}

}  // namespace
}  // namespace hydroprint::calibrate
