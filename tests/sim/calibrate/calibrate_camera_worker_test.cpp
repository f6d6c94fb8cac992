// The verb calibrate with a camera that was calibrated by calibrate-camera.
#include <cmath>

#include "hydroprint/v1/report.pb.h"
#include "sim/registration/camera/calibration_board.h"
#include "tests/sim/calibrate/calibrate_fixture.h"
#include "tests/sim/worker/report_file.h"

namespace hydroprint::calibrate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ended;
using testing::Rig;

constexpr int kViews = 10;

/// Pose of the board in the i-th view: all over the image, tilted in all directions, near and far.
Pose held(int i) {
  const Eigen::Vector3d about(std::cos(1.7 * i), std::sin(1.7 * i), 0);
  Pose X_CB = Pose::Identity();
  X_CB.linear() = Eigen::AngleAxisd((i % 3) * 16 * kDegree, about).matrix() *
                  Eigen::Vector3d(1, -1, -1).asDiagonal();
  X_CB.translation() =
      (620 + 45 * (i % 5)) * Eigen::Vector3d(0.28 * std::cos(2.4 * i), 0.2 * std::sin(2.4 * i), 1);
  return X_CB;
}

/// Error of a pose from a file: the shift at the object's middle in mm, and the rotation in rad.
std::pair<Eigen::Vector3d, double> off(const json& pose, const Pose& truth) {
  const auto& q = pose["rotation_wxyz"];
  const auto& t = pose["translation_mm"];
  Pose found(Eigen::Translation3d(t[0], t[1], t[2]));
  found.rotate(Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
  const Eigen::Vector3d middle = truth.inverse() * Eigen::Vector3d(4, -3, 60);
  return {found * middle - truth * middle,
          Eigen::AngleAxisd(found.linear().transpose() * truth.linear()).angle()};
}

TEST_F(Calibrate, FindsTheObjectWithACalibratedCamera) {
  take_frames(8);
  Rig bench;
  bench.lens = rig.lens;
  bench.furnished = false;
  std::vector<std::string> flags = {"calibrate-camera", "--out", path("camera"), "--frames"};
  for (int i = 0; i < kViews; ++i) {
    bench.more = {
        testing::body_of(registration::calibration_board(), bench.X_CF().inverse() * held(i))};
    flags.push_back(path("view" + std::to_string(i)));
    write_frames(flags.back(), bench.frames(4, kCamera, 100 * (i + 1)));
  }
  const Ended lens = run(flags);
  ASSERT_EQ(lens.status, 0) << lens.err;
  EXPECT_NEAR(read(path("camera/camera.json"))["fx_px"], rig.lens.focal_px, 2);
  EXPECT_EQ(read(path("camera/camera.json"))["pattern"]["patch_px"], 4);
  const auto taken = testing::read_message<v1::CalibrateCameraReport>(path("camera/report.json"));
  EXPECT_NEAR(taken.lens(0), rig.lens.focal_px, 2);
  EXPECT_EQ(taken.covariance_size(), 81);

  const Ended ended = calibrate(
      {"--camera", path("camera/camera.json"), "--gripper-mm", std::to_string(rig.gripper_mm)});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const json found = read(path("out/calibration.json"));
  const auto [off_mm, rad] = off(found["pose"], X_FO);
  // The camera sees no face of the board that determines the shift along x, so this shift comes
  // from the nominal pose.
  EXPECT_LT(off_mm.tail<2>().norm(), 0.8);
  ASSERT_EQ(found["from_nominal_pose"].size(), 1U);
  std::string along = found["from_nominal_pose"][0];
  std::erase(along, '-');  // the direction may have either sign
  EXPECT_EQ(along.substr(0, 15), "shift along (1.");
  EXPECT_LT(rad, 0.2 * kDegree);
  json pose = found["pose"];
  pose["from_nominal_pose"] = found["from_nominal_pose"];
  pose["error_p95_mm"] = found["uncertainty"]["error_p95_mm"];
  EXPECT_EQ(pose, read(path("out/pose.json")));
  EXPECT_EQ(found["film_frame"]["markers"].size(), 4U);
  EXPECT_LT(std::abs(found["water"]["z_mm"].get<double>()), 1);
  const auto report = testing::read_message<v1::CalibrateReport>(path("out/report.json"));
  ASSERT_EQ(report.run().warnings_size(), 1) << report.run().DebugString();
  EXPECT_EQ(report.run().warnings(0).code(), v1::Warning::POSE_UNCONSTRAINED);
  EXPECT_EQ(
      report.calibration().DebugString(),
      testing::read_message<v1::CalibrationFacts>(path("out/calibration.json")).DebugString());
  for (const char* picture : {"out/alignment.png", "out/error.png"})
    EXPECT_GT(fs::file_size(path(picture)), 10000U) << picture;
  // The verb template accepts the result as its pose.
  EXPECT_EQ(run({"template", "--mesh", path("board.obj"), "--pose", path("out/pose.json"), "--out",
                 path("template")})
                .status,
            0);
}

}  // namespace
}  // namespace hydroprint::calibrate
