// The verb fuse, with frames of a virtual camera that is swept by hand.
#include <algorithm>
#include <cmath>

#include "hardware/simulator/scene/shapes.h"
#include "hydroprint/v1/report.pb.h"
#include "sim/calibrate/camera_file.h"
#include "sim/mesh/read/read_model.h"
#include "tests/sim/calibrate/calibrate_fixture.h"
#include "tests/sim/worker/report_file.h"
#include "tests/support/swept_camera.h"

namespace hydroprint::calibrate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ended;

class Fuse : public Calibrate {
 protected:
  void SetUp() override {
    registration::CameraCalibration calibration;
    calibration.lens = camera.lens();
    calibration.views = 1;
    folder.write("camera.json", camera_json(calibration));
  }
  [[nodiscard]] Ended fuse(const std::vector<std::string>& more) const {
    std::vector<std::string> all = {"fuse",      "--frames", path("frames"),      "--out",
                                    path("out"), "--camera", path("camera.json"), "--json"};
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  }

  testing::SweptCamera camera{
      {{"block", simulated_scene::box({-40, -25, 30}, {35, 30, 90}), false}}};
};

TEST_F(Fuse, WritesTheRigsSurfaceInTheFilmFrameAndTheCamerasPath) {
  write_frames(path("frames"), camera.frames(10));
  const Ended ended = fuse({"--layout", layout, "--threads", "2"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto report = testing::read_message<v1::FuseReport>(path("out/report.json"));
  EXPECT_EQ(report.run().verb(), "fuse");
  EXPECT_EQ(report.frames_tracked(), 10);
  EXPECT_EQ(report.frames_lost(), 0);
  EXPECT_LT(report.rms_mm(), 2);
  EXPECT_EQ(report.film_frame().markers_size(), 4);
  for (const std::string& name : report.run().artifacts())
    EXPECT_TRUE(fs::exists(fs::path(path("out")) / name)) << name;

  const auto model = mesh::read_model(path("out/scan.ply"), 1, {});
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->triangles.size(), static_cast<std::size_t>(report.mesh().triangles()));
  std::vector<double> top;  // heights of the block's top
  for (const Eigen::Vector3d& p : model->vertices)
    if (std::abs(p.x()) < 25 && std::abs(p.y()) < 15 && p.z() > 60 && p.z() < 120)
      top.push_back(p.z());
  ASSERT_GT(top.size(), 100U);
  std::sort(top.begin(), top.end());
  EXPECT_NEAR(top[top.size() / 2], 90, 1);
}

TEST_F(Fuse, ALostCameraIsAnErrorAndLeavesNothing) {
  std::vector<scan::DepthFrame> frames = camera.frames(2);
  for (int i = 0; i < 11; ++i) frames.push_back(testing::wall_frame(600));
  write_frames(path("frames"), frames);
  const Ended ended = fuse({});
  EXPECT_EQ(ended.status, 3);
  EXPECT_NE(ended.err.find("depth frame 12 of 13 (at 0.4 s)"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("more slowly"), std::string::npos) << ended.err;
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(Fuse, RefusesFramesWithoutTimesAndVoxelsOutOfRange) {
  write_frames(path("frames"), camera.frames(2));
  EXPECT_EQ(fuse({"--voxel-mm", "0.1"}).status, 3);
  json listing = read(path("frames/frames.json"));
  for (auto& frame : listing["frames"]) frame.erase("time_s");
  folder.write("frames/frames.json", listing.dump());
  const Ended ended = fuse({});
  EXPECT_EQ(ended.status, 3);
  EXPECT_NE(ended.err.find("Record the frames again"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace hydroprint::calibrate
