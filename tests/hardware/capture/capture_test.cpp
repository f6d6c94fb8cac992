// Tests hydroprint-capture with the camera of hydroprint-virtual-rig, through OpenNI2.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "hardware/simulator/camera/renderer.h"
#include "hardware/simulator/drive/scene.h"
#include "sim/image/io/grey16.h"
#include "sim/image/io/image_file.h"
#include "tests/support/content.h"
#include "tests/support/paths.h"
#include "tests/support/virtual_rig.h"

namespace hydroprint::capture {
namespace {

namespace fs = std::filesystem;
using testing::content;
using namespace std::string_literals;

/// The program and its first arguments. Leak detection of AddressSanitizer is off: OpenNI2 does not
/// free everything when it unloads its drivers, and unloaded code has no name for a suppression.
#ifdef __SANITIZE_ADDRESS__
const std::vector<std::string> kCapture = {"/usr/bin/env", "ASAN_OPTIONS=detect_leaks=0",
                                           testing::program_path("hydroprint-capture")};
#else
const std::vector<std::string> kCapture = {testing::program_path("hydroprint-capture")};
#endif

/// --patience-s, in s, for operations that are slow on a busy machine but do not hang.
constexpr const char* kLong = "400";

constexpr const char* kScene = R"(
[object]
mesh = "wedge.obj"
[camera]
seed = 3
clock = "frames"
)";
constexpr const char* kWedge =
    "v -30 -30 -40\nv 30 -30 -40\nv 0 40 -40\nv 0 0 0\n"
    "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// A virtual rig and captures from its camera.
class Capture : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path path(const char* name) const { return folder_.path() / name; }

  static testing::Ended capture(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), kCapture.begin(), kCapture.end());
    return testing::run(std::move(arguments));
  }

  /// Captures from the rig into `out`.
  testing::Ended capture_live(const std::vector<std::string>& more,
                              const std::string& patience_s = kLong) {
    std::vector<std::string> all = {"--device", rig_.camera(),  "--out",   path("out").string(),
                                    "--json",   "--patience-s", patience_s};
    all.insert(all.end(), more.begin(), more.end());
    return capture(all);
  }

  /// Starts a capture that takes a minute, and waits for its first frames.
  std::unique_ptr<testing::Process> long_capture(const std::string& patience_s = kLong) {
    testing::ProcessOptions options;
    options.files = {{3, path("progress")}};
    std::vector<std::string> all = kCapture;
    for (const std::string& word :
         {"--device"s, rig_.camera(), "--out"s, path("out").string(), "--record"s,
          path("long.oni").string(), "--seconds"s, "60"s, "--patience-s"s, patience_s, "--json"s,
          "--progress-fd"s, "3"s}) {
      all.push_back(word);
    }
    auto out = std::make_unique<testing::Process>(all, options);
    while (out->running()) {
      const std::string told = content(path("progress"));
      if (std::count(told.begin(), told.end(), '\n') > 1) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return out;
  }

  /// Expects that a capture failed with this status and reason, in one line, and left no files.
  void expect_failure(const testing::Ended& ended, int status, const std::string& reason) {
    EXPECT_EQ(ended.status, status) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    const auto output = nlohmann::json::parse(ended.out, nullptr, false);
    ASSERT_TRUE(output.is_object()) << ended.out;
    EXPECT_EQ(output["error"].value("reason", ""), reason) << ended.err;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(name.find("out") == std::string::npos && name.find("part") == std::string::npos &&
                  name != "long.oni")
          << name;
    }
  }

  testing::TemporaryFolder folder_;
  testing::VirtualRig rig_{{.start_mm = 50, .scene = kScene, .files = {{"wedge.obj", kWedge}}}};
};

/// The PNG of one entry of frames.json.
std::string png_of(const fs::path& folder, const nlohmann::json& frame) {
  return content(folder / frame.at("file").get<std::string>());
}

nlohmann::json frames_of(const fs::path& folder) {
  return nlohmann::json::parse(content(folder / "frames.json"));
}

TEST_F(Capture, LiveAndRecordedFramesMatchTheSceneBitForBit) {
  const auto recording = path("take.oni");
  const auto live = capture_live({"--seconds", "0.1", "--record", recording.string()});
  ASSERT_EQ(live.status, 0) << live.err;
  const auto scene = simulated_drive::read_scene(rig_.folder() / "scene.toml");
  const auto scenery = simulated_drive::scenery_of(*scene);
  ASSERT_TRUE(scenery);
  const auto renderer =
      simulated_camera::Renderer::create(*scenery, simulated_camera::lens_of(*scenery));
  std::map<int, std::string> drawn;
  const auto expected = [&](int index) {
    std::string& out = drawn[index];
    if (!out.empty()) return out;
    simulated_scene::Sight sight;
    sight.time_s = (index - 1) / 30.0;
    sight.gripper_height_mm = scene->water_mm - scene->start_mm;
    const auto file = image::encode_png({640, 480, (*renderer)->photograph(sight, index)});
    return out = std::string(file->begin(), file->end());
  };
  const auto told = frames_of(path("out"));
  EXPECT_EQ(told["source"]["serial"], "virtual-3");
  EXPECT_NEAR(told["horizontal_fov_rad"].get<double>(), simulated_camera::horizontal_fov_rad(),
              1e-6);
  ASSERT_FALSE(told["frames"].empty());
  for (const auto& frame : told["frames"]) {
    const int index = frame["index"];
    EXPECT_NEAR(frame["time_s"].get<double>(), (index - 1) / 30.0, 1e-6);
    EXPECT_TRUE(png_of(path("out"), frame) == expected(index)) << index;
  }

  const auto again = capture({"--recording", recording.string(), "--out", path("again").string()});
  ASSERT_EQ(again.status, 0) << again.err;
  const auto played = frames_of(path("again"));
  const std::string first = png_of(path("again"), played["frames"][0]);
  // Finds the index of the first recorded frame. It follows the first captured frame at the latest.
  const int latest = told["frames"][0]["index"].get<int>() + 1;
  int start = 1;
  while (start < latest && first != expected(start)) ++start;
  std::set<int> recorded;
  for (const auto& frame : played["frames"]) {
    const int index = start + static_cast<int>(std::lround(30 * frame["time_s"].get<double>()));
    EXPECT_TRUE(png_of(path("again"), frame) == expected(index)) << index;
    recorded.insert(index);
  }
  // The first captured frame may precede the recording.
  for (std::size_t i = 1; i < told["frames"].size(); ++i) {
    EXPECT_TRUE(recorded.contains(told["frames"][i]["index"].get<int>())) << i;
  }
  EXPECT_NEAR(played["horizontal_fov_rad"].get<double>(), told["horizontal_fov_rad"].get<double>(),
              1e-6);
}

TEST_F(Capture, MissingCameraIsNamedWithARemedy) {
  expect_failure(
      capture({"--device", "hydroprint:/nowhere", "--out", path("out").string(), "--json"}), 3,
      "CAMERA_NOT_FOUND");
  rig_.act("camera gone");
  expect_failure(capture_live({}), 3, "CAMERA_NOT_FOUND");
}

TEST_F(Capture, UnpluggedCameraFailsAndWorksAgainAfterReplugging) {
  const auto capture = long_capture();
  rig_.act("camera gone");
  expect_failure(capture->wait(), 4, "CAMERA_GONE");
  rig_.act("camera well");
  const auto again = capture_live({"--seconds", "0.05"});
  EXPECT_EQ(again.status, 0) << again.err;
}

TEST_F(Capture, CameraIsGoneWhenItsRigDies) {
  const auto capture = long_capture();
  rig_.signal(SIGKILL);
  expect_failure(capture->wait(), 4, "CAMERA_GONE");
}

TEST_F(Capture, FrozenAndBlackCamerasAreDetected) {
  for (const auto& [line, reason] :
       {std::pair{"camera frozen", "CAMERA_FROZEN"}, {"camera black", "CAMERA_BLACK"}}) {
    rig_.act("camera well");
    const auto capture = long_capture();
    rig_.act(line);
    expect_failure(capture->wait(), 4, reason);
    fs::remove(path("progress"));
  }
}

TEST_F(Capture, SilentCameraTimesOut) {
  const auto capture = long_capture("1");
  rig_.signal(SIGSTOP);
  expect_failure(capture->wait(), 4, "CAMERA_STALLED");
  rig_.signal(SIGCONT);
}

TEST_F(Capture, HangingDriverTimesOut) {
  rig_.act("camera hung");
  expect_failure(capture_live({}, "1"), 4, "CAMERA_STALLED");
}

TEST_F(Capture, CancellingLeavesNoFiles) {
  const auto capture = long_capture();
  capture->signal(SIGTERM);
  expect_failure(capture->wait(), 130, "");
}

TEST_F(Capture, InvalidOrTruncatedRecordingsAreRefused) {
  const auto recording = path("take.oni");
  const auto taken = capture_live({"--seconds", "0.15", "--record", recording.string()});
  ASSERT_EQ(taken.status, 0) << taken.err;
  fs::remove_all(path("out"));
  // The second half of the file is zeros written by OpenNI2; truncating them loses no data.
  std::string whole = content(recording);
  whole.resize(whole.find_last_not_of('\0') + 1);
  std::vector<std::string> files = {"", "junk", std::string(100000, 'x'), whole.substr(0, 100)};
  for (int i = 1; i < 8; ++i) files.push_back(whole.substr(0, whole.size() * i / 8));
  for (const std::string& bytes : files) {
    const auto file = folder_.write("bad.oni", bytes);
    const auto ended =
        capture({"--recording", file.string(), "--out", path("out").string(), "--json"});
    EXPECT_EQ(ended.signal, 0) << bytes.size();
    expect_failure(ended, 3, "RECORDING_INVALID");
  }
  expect_failure(
      capture({"--recording", path("none.oni").string(), "--out", path("out").string(), "--json"}),
      3, "");
}

/// The output of --live: heads with their pictures, and the remaining text.
struct Told {
  std::vector<std::pair<nlohmann::json, std::string>> pictures;
  std::string rest;
};
Told told_by(const std::string& bytes) {
  Told out;
  for (std::size_t at = 0;;) {
    const std::size_t end = bytes.find('\n', at);
    const auto head = nlohmann::json::parse(bytes.substr(at, end - at), nullptr, false);
    if (end == std::string::npos || !head.contains("bytes") ||
        bytes.size() - end - 1 < head["bytes"].get<std::size_t>()) {
      out.rest = bytes.substr(at);
      return out;
    }
    out.pictures.emplace_back(head, bytes.substr(end + 1, head["bytes"].get<std::size_t>()));
    at = end + 1 + head["bytes"].get<std::size_t>();
  }
}

TEST_F(Capture, LivePicturesShowNearAndFarUntilASignal) {
  testing::ProcessOptions options;
  options.files = {{1, path("live")}};
  std::vector<std::string> all = kCapture;
  for (const std::string& word : {"--live"s, "--device"s, rig_.camera(), "--every-s"s, "0.2"s,
                                  "--patience-s"s, std::string(kLong), "--json"s}) {
    all.push_back(word);
  }
  testing::Process live(all, options);
  while (live.running() && told_by(content(path("live"))).pictures.size() < 2) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  live.signal(SIGTERM);
  const auto ended = live.wait();
  EXPECT_EQ(ended.status, 130) << ended.err;
  const Told told = told_by(content(path("live")));
  EXPECT_TRUE(nlohmann::json::parse(told.rest).contains("error")) << told.rest;
  ASSERT_GE(told.pictures.size(), 2U);
  const auto& [head, png] = told.pictures.back();
  EXPECT_GT(head["farthest_mm"], head["nearest_mm"]);
  EXPECT_NE(png, told.pictures.front().second)
      << "the last picture shows another frame than the first";
  const auto read = image::read_image({png.begin(), png.end()}, "live", {});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->image.width, head["width"]);
  EXPECT_EQ(read->image.height, head["height"]);
  // The colour map viridis ranges from yellow to violet. Grey pixels are not measured.
  std::size_t near = 0, far = 0, grey = 0;
  for (const image::Texel& texel : read->image.texels) {
    if (texel.r == texel.g && texel.g == texel.b) ++grey;
    if (texel.g > 3 * texel.b && texel.r > 3 * texel.b) ++near;
    if (texel.b > 5 * texel.g) ++far;
  }
  EXPECT_GT(near, 0U);
  EXPECT_GT(far, 0U);
  const auto pixels = static_cast<double>(read->image.texels.size());
  EXPECT_NEAR(static_cast<double>(grey) / pixels, 1 - head["measured_share"].get<double>(), 0.1);
}

TEST_F(Capture, LiveModeReportsALostCamera) {
  rig_.act("camera black");
  const auto ended =
      capture({"--live", "--device", rig_.camera(), "--patience-s", kLong, "--json"});
  EXPECT_EQ(ended.status, 4) << ended.err;
  EXPECT_EQ(nlohmann::json::parse(told_by(ended.out).rest)["error"]["reason"], "CAMERA_BLACK");
}

TEST_F(Capture, WrongUsageIsRefused) {
  EXPECT_EQ(capture({}).status, 2);
  EXPECT_EQ(capture({"--out", "x", "--seconds", "0"}).status, 2);
  EXPECT_EQ(capture({"--out", "x", "--live"}).status, 2);
  EXPECT_EQ(capture({"--out", "x", "--every-s", "1"}).status, 2);
  EXPECT_EQ(capture({"--out", "x", "--device", "a", "--recording", "b"}).status, 2);
  EXPECT_EQ(capture({"--help"}).status, 0);
}

}  // namespace
}  // namespace hydroprint::capture
