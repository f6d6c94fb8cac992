// `hydroprint plan next` with a depth camera: the hung object is captured and calibrated.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/daemon/api/rig_support.h"
#include "tests/support/paths.h"
#include "tests/support/terminal.h"

namespace hydroprint::tests {
namespace {

using nlohmann::json;
using Arguments = std::vector<std::string>;

constexpr char kTwoDips[] = R"([
  {"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [1, 2, 0], "depth_mm": 4},
  {"rotation_wxyz": [0, 1, 0, 0], "translation_mm": [3, 4, 0], "depth_mm": 4}])";

class PlanCamera : public ::testing::Test {
 protected:
  PlanCamera() {
    DaemonProcess::Options options = DaemonProcess::fake();
    options.extra = rig_.section() + "[camera]\ndevice = \"" + rig_.camera() +
                    "\"\npatience_s = 60\nlayout = \"" +
                    testing::source_path("deploy/rig_layout.toml.example") + "\"\n";
    daemon_ = std::make_unique<DaemonProcess>(folder_.path(), options);
    const std::string mesh = folder_.write("cup.obj", "sleep 0.1");
    const std::string dips = folder_.write("two.json", kTwoDips);
    const auto planned = client({"submit", "plan", "--mesh", mesh, "--scale", "2", "--film",
                                 "50x60", "--immersions", dips, "--name", "my cup", "--wait"});
    EXPECT_EQ(planned.status, 0) << planned.err;
  }

  Arguments command(const Arguments& arguments) const {
    Arguments all{testing::program_path("hydroprint"), "--server", daemon_->address()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  }
  hydroprint::testing::Ended client(const Arguments& arguments) const {
    return hydroprint::testing::run(command(arguments));
  }
  json client_json(Arguments arguments) const {
    arguments.emplace_back("--json");
    return json::parse(client(arguments).out);
  }
  json jobs() const { return client_json({"list"}).at("jobs"); }

  TemporaryFolder folder_;
  VirtualRig rig_{{.scene = "[camera]\nseed = 7\n"}};
  std::unique_ptr<DaemonProcess> daemon_;
};

TEST_F(PlanCamera, CalibratesTheHungObjectWithThePlansMeshAndPose) {
  const Arguments second{"plan", "next", "1", "--immersion", "2"};
  const auto refused = client(second);
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("--yes"), std::string::npos) << refused.err;
  EXPECT_EQ(jobs().size(), 1U) << "nothing was captured";

  hydroprint::testing::Terminal at(
      command({"plan", "next", "1", "--immersion", "2", "--out", folder_.path() / "second"}));
  ASSERT_TRUE(at.shows("dip 2 of 2: hang the object")) << at.screen();
  ASSERT_TRUE(at.shows("Enter when it hangs")) << at.screen();
  at.type("\n");
  ASSERT_TRUE(at.shows("calibrations/1 (active)", std::chrono::seconds(60))) << at.screen();
  ASSERT_TRUE(at.shows("next: hydroprint plan next 1")) << at.screen();
  EXPECT_EQ(at.wait(), 0) << at.screen();
  EXPECT_TRUE(at.is_cooked());

  const json all = jobs();  // newest first
  ASSERT_EQ(all.size(), 3U) << "plan, capture, calibrate";
  EXPECT_EQ(all[0].at("displayName"), "my cup, dip 2 of 2");
  const json spec = all[0].at("calibrate"), plan = all[2].at("plan");
  EXPECT_EQ(spec.at("captureJob"), all[1].at("name"));
  EXPECT_EQ(spec.at("mesh"), plan.at("object").at("mesh"));
  EXPECT_EQ(spec.at("scale"), 2);
  EXPECT_EQ(spec.at("film"), "50x60");
  EXPECT_EQ(spec.at("pose"), plan.at("immersions").at(1).at("pose"));
  EXPECT_EQ(client_json({"plan", "show", "1"}).at("dips").at(1).at("calibration"),
            "calibrations/1");
}

TEST_F(PlanCamera, CtrlCBeforeTheCaptureDoesNothing) {
  hydroprint::testing::Terminal at(
      command({"plan", "next", "1", "--out", folder_.path() / "first"}));
  ASSERT_TRUE(at.shows("Enter when it hangs")) << at.screen();
  at.type("\x03");
  EXPECT_EQ(at.wait(), 130) << at.screen();
  EXPECT_TRUE(at.is_cooked());
  EXPECT_EQ(jobs().size(), 1U);
}

}  // namespace
}  // namespace hydroprint::tests
