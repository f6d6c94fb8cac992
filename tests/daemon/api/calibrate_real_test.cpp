// Calibrates with the virtual rig's camera and the real programs.
#include <Eigen/Geometry>
#include <chrono>
#include <numbers>
#include <sstream>
#include <thread>

#include "sim/calibrate/camera_file.h"
#include "sim/sample/sample.h"
#include "tests/daemon/api/calibrate_support.h"
#include "tests/support/depth_scene.h"

namespace hydroprint::tests {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::string json_of(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const auto t = pose.translation();
  return nlohmann::json{{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
                        {"translation_mm", {t.x(), t.y(), t.z()}}}
      .dump();
}

Pose pose_of(const v1::Pose& pose) {
  const auto& q = pose.rotation_wxyz();
  Pose out = Pose::Identity();
  out.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().matrix();
  out.translation() = Eigen::Vector3d(pose.translation_mm().data());
  return out;
}

/// The sample board in the gripper, slightly crooked, and tilted so that the camera sees two of its
/// sides.
class CalibrateReal : public CameraTest {
 protected:
  CalibrateReal() {
    EXPECT_TRUE(sample::write_sample("board", folder.path()));
    board = content(folder.path() / "board.obj");
    const auto surface = testing::surface_of(sample::make_model("board").value());
    Eigen::AlignedBox3d box;
    for (const auto& p : surface.points) box.extend(p);
    nominal = Eigen::Translation3d(0, 0, 75) *
              Eigen::AngleAxisd(-30 * kDegree, Eigen::Vector3d::UnitX()) *
              Eigen::AngleAxisd(45 * kDegree, Eigen::Vector3d::UnitZ()) *
              Eigen::Translation3d(-box.center());
    const Eigen::Translation3d middle(kMiddle_mm);
    X_FO = middle * testing::crooked(5 * kDegree, 0, 4) * middle.inverse() *
           Eigen::Translation3d(4, -3, 0) * nominal;
    double gripper_mm = 0;
    for (const auto& p : surface.points) {
      lowest_mm = std::min(lowest_mm, (X_FO * p).z());
      gripper_mm = std::max(gripper_mm, (X_FO * p).z());
    }
    water_mm = gripper_mm + kAxis_mm;
    const Pose X_GO = Eigen::Translation3d(0, 0, -gripper_mm) * X_FO;
    start_rig("[object]\nmesh = \"board.obj\"\npose = \"held.json\"\n",
              {{"board.obj", board}, {"held.json", json_of(X_GO)}});
    start_daemon({}, 60);
    registration::CameraCalibration camera;
    camera.lens = testing::lens_of(simulated_camera::drawn_lens(7));
    camera.views = 1;
    lens = ann->upload(calibrate::camera_json(camera));
  }

  /// Waits for the end of a job, without a time limit.
  v1::Job ended(const v1::Job& job) {
    for (;;) {
      const v1::Job now = ann->job(job.name());
      if (finished(now)) return now;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  v1::Job calibrate(const v1::Job& capture, double scale) {
    v1::Job wanted = calibrate_of(capture, board);
    wanted.mutable_calibrate()->mutable_camera()->set_name("lens.json");
    wanted.mutable_calibrate()->mutable_camera()->set_asset(lens);
    wanted.mutable_calibrate()->set_scale(scale);
    const Eigen::Quaterniond q(nominal.linear());
    const Eigen::Vector3d t = nominal.translation();
    auto& pose = *wanted.mutable_calibrate()->mutable_pose();
    for (const double x : {q.w(), q.x(), q.y(), q.z()}) pose.add_rotation_wxyz(x);
    for (const double x : {t.x(), t.y(), t.z()}) pose.add_translation_mm(x);
    return ended(create(wanted));
  }

  v1::Job seen() {
    v1::Job capture = ended(create(capture_of(0.5)));
    EXPECT_EQ(capture.state(), v1::Job::SUCCEEDED) << capture.error().message();
    return capture;
  }
  /// Runs a calibrate job and returns its calibration.
  v1::Calibration calibrated(const v1::Job& capture) {
    const v1::Job job = calibrate(capture, 1);
    EXPECT_EQ(job.state(), v1::Job::SUCCEEDED) << job.error().message();
    return all().front();
  }
  void expect_near_truth(const v1::Calibration& found) const {
    const Pose off = pose_of(found.pose()) * X_FO.inverse();
    EXPECT_LT((off * kMiddle_mm - kMiddle_mm).norm(), 1.5);
    EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 1 * kDegree);
  }

  const Eigen::Vector3d kMiddle_mm{4, -3, 75};
  std::string board, lens;
  Pose nominal, X_FO;
  double lowest_mm = 1e9;
};

TEST_F(CalibrateReal, PoseOfTheObjectIsFound) {
  ann->make_ready();
  ann->go_to(kAxis_mm);
  // Takes both captures first, since on a busy machine the rig may lose its reference later.
  const v1::Job capture = seen();
  rig->act("marker left pushed 9 -6");
  const v1::Job later = seen();
  const v1::Calibration found = calibrated(capture);
  expect_near_truth(found);
  ASSERT_EQ(found.markers_size(), 4);
  for (const auto& marker : found.markers()) EXPECT_TRUE(marker.used()) << marker.why_not();
  EXPECT_LT(found.error_p95_mm(), 2);
  EXPECT_EQ(found.from_nominal_pose_size(), 0) << found.from_nominal_pose(0);
  EXPECT_NEAR(found.contact_mm(), found.axis_mm() + lowest_mm, 2)
      << "axis position at first contact";
  EXPECT_EQ(ann->download(found.picture()).substr(1, 3), "PNG");

  const v1::Calibration again = calibrated(later);
  expect_near_truth(again);
  for (const auto& marker : again.markers())
    EXPECT_EQ(marker.used(), marker.name() != "left") << marker.name() << ": " << marker.why_not();
}

TEST_F(CalibrateReal, ScansThatDoNotFitAreRefusedWithAReason) {
  const v1::Job capture = ended(create(capture_of(0.2)));
  const v1::Job metres = calibrate(capture, 0.001);
  EXPECT_EQ(metres.state(), v1::Job::FAILED);
  EXPECT_EQ(metres.error().reason(), v1::WRONG_UNITS) << metres.error().message();
  EXPECT_NE(metres.error().message().find("metres"), std::string::npos) << metres.error().message();
  for (const char* marker : {"left", "near"})
    rig->act(std::string("marker ") + marker + " knocked-over");
  const v1::Job toppled = calibrate(ended(create(capture_of(0.2))), 1);
  EXPECT_EQ(toppled.state(), v1::Job::FAILED);
  EXPECT_EQ(toppled.error().reason(), v1::TOO_FEW_MARKERS) << toppled.error().message();
  EXPECT_EQ(all().size(), 0U);
}

}  // namespace
}  // namespace hydroprint::tests
