// The whole loop as users run it, with all real programs.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "sim/calibrate/camera_file.h"
#include "tests/daemon/api/rig_support.h"
#include "tests/support/depth_scene.h"
#include "tests/support/paths.h"

namespace hydroprint::tests {
namespace {

using nlohmann::json;

constexpr int kCamera = 7, kWater_mm = 240;

class LoopCli : public ::testing::Test {
 protected:
  LoopCli() {
    DaemonProcess::Options options;
    options.extra = rig.section() + "[camera]\ndevice = \"" + rig.camera() +
                    "\"\npatience_s = 60\nlayout = \"" +
                    testing::source_path("deploy/rig_layout.toml.example") + "\"\n";
    daemon = std::make_unique<DaemonProcess>(folder.path(), options);
    registration::CameraCalibration camera;
    camera.lens = testing::lens_of(simulated_camera::drawn_lens(kCamera));
    camera.views = 1;
    lens = folder.write("lens.json", calibrate::camera_json(camera)).string();
  }

  hydroprint::testing::Ended loop(const std::vector<std::string>& more,
                                  const std::string& camera) const {
    std::vector<std::string> all{"/usr/bin/env",
                                 "XDG_RUNTIME_DIR=" + folder.path().string(),
                                 testing::program_path("hydroprint"),
                                 "--server",
                                 daemon->address(),
                                 "loop",
                                 "--camera",
                                 camera,
                                 "--model",
                                 "stokes",
                                 "--dpi",
                                 "75",
                                 "--poses",
                                 "1",
                                 "--out",
                                 out().string()};
    all.insert(all.end(), more.begin(), more.end());
    return hydroprint::testing::run(all);
  }
  [[nodiscard]] std::filesystem::path out() const { return folder.path() / "the loop"; }

  VirtualRig rig{{.scene = "[water]\nat_mm = " + std::to_string(kWater_mm) +
                           ".0\n[camera]\nseed = " + std::to_string(kCamera) + "\n"}};
  TemporaryFolder folder;
  std::unique_ptr<DaemonProcess> daemon;
  std::string lens;
};

TEST_F(LoopCli, RunsTheWholeLoopForOnePose) {
  const auto ended = loop({"--object", "board", "--control", rig.control()}, lens);
  const json report = json::parse(std::ifstream(out() / "report.json"));
  ASSERT_EQ(ended.status, report["passed"] ? 0 : 4) << ended.err;
  EXPECT_NE(ended.out.find("169 cross-points land within"), std::string::npos) << ended.out;
  EXPECT_EQ(report["lost_cross_points"], 0);
  const json& errors = report["errors"];
  EXPECT_LT(errors["numerics"]["p95_mm"], 0.1) << "both dips are identical";
  EXPECT_LT(errors["placement"]["p95_mm"], 2) << ended.out;
  EXPECT_GT(errors["placement"]["p95_mm"], errors["numerics"]["p95_mm"]);
  const json& round = report["rounds"][0];
  EXPECT_NE(round["truth"]["printer_scale"], 1);
  EXPECT_LT(round["turn_off_deg"], 1);
  EXPECT_LT(std::abs(round["contact_off_mm"].get<double>()), 1);
  EXPECT_EQ(round["jobs"].size(), 5U) << "capture, calibrate, simulate, print-image, dip";
  for (const std::string picture : round["pictures"])
    EXPECT_TRUE(std::filesystem::exists(out() / picture)) << picture;
  EXPECT_TRUE(std::filesystem::exists(out() / "pose1-print.pdf"));
  EXPECT_TRUE(std::filesystem::exists(out() / "report.html"));
}

/// The lens of a camera that was not calibrated has large errors.
TEST_F(LoopCli, StopsAtACalibrationWithALargeErrorAndSaysWhy) {
  const auto ended = loop({"--object", "board", "--control", rig.control()}, "active");
  EXPECT_EQ(ended.status, 4) << ended.err;
  EXPECT_NE(ended.err.find("the pose may be wrong by"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("calibrate again"), std::string::npos) << ended.err;
  EXPECT_FALSE(std::filesystem::exists(out() / "pose1-print.pdf"));
}

TEST_F(LoopCli, CameraCommandShowsTheCurrentPicture) {
  const auto ask = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{testing::program_path("hydroprint"), "--server", daemon->address(),
                                 "camera"};
    all.insert(all.end(), more.begin(), more.end());
    return hydroprint::testing::run(all);
  };
  const auto picture = folder.path() / "depth.png";
  hydroprint::testing::Ended looked;
  ASSERT_TRUE(wait_until(  // the camera may still be starting
      [&] {
        return (looked = ask({"--out", picture.string(), "--json"})).status == 0;
      }))
      << looked.err;
  const json told = json::parse(looked.out);
  EXPECT_EQ(told.at("camera"), "Hydroprint virtual rig");
  EXPECT_LT(told.at("nearestMm").get<double>(), told.at("farthestMm").get<double>());
  std::ifstream file(picture, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  EXPECT_NE(ask({}).out.find("mm, "), std::string::npos);
  EXPECT_EQ(ask({"--out", (folder.path() / "no folder/x.png").string()}).status, 3);
}

TEST_F(LoopCli, ReportsMissingRequirements) {
  const auto ended = loop({"--control", (folder.path() / "nothing").string()}, lens);
  EXPECT_EQ(ended.status, 5);
  EXPECT_NE(ended.err.find("no virtual rig responds"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace hydroprint::tests
