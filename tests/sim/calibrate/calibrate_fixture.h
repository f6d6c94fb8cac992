#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "sim/image/io/grey16.h"
#include "tests/support/depth_scene.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::calibrate {

inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr std::uint64_t kCamera = 7;

inline nlohmann::json read(const std::filesystem::path& path) {
  return nlohmann::json::parse(std::ifstream(path));
}

/// Writes frames in the format of hydroprint-capture.
inline void write_frames(const std::filesystem::path& folder,
                         const std::vector<scan::DepthFrame>& frames) {
  std::filesystem::create_directories(folder);
  nlohmann::json listing = {{"width", 640},
                            {"height", 480},
                            {"horizontal_fov_rad", simulated_camera::horizontal_fov_rad()},
                            {"vertical_fov_rad", simulated_camera::vertical_fov_rad()},
                            {"frames", nlohmann::json::array()}};
  for (const scan::DepthFrame& frame : frames) {
    const std::size_t index = listing["frames"].size();
    const std::string name = std::to_string(index) + ".png";
    const std::vector<std::uint16_t> grey(frame.depth_mm.begin(), frame.depth_mm.end());
    ASSERT_TRUE(image::write_png(folder / name, {frame.width_px, frame.height_px, grey}));
    listing["frames"].push_back({{"file", name}, {"time_s", static_cast<double>(index) / 30}});
  }
  std::ofstream(folder / "frames.json") << listing;
}

inline void write_obj(const std::filesystem::path& path, const mesh::Surface& surface) {
  std::ofstream out(path);
  for (const Eigen::Vector3d& p : surface.points) out << "v " << p.transpose() << "\n";
  for (const Eigen::Vector3i& t : surface.triangles)
    out << "f " << (t.array() + 1).transpose() << "\n";
}

/// Fixture with a board in the gripper, seen by the virtual camera.
class Calibrate : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder.path() / name; }
  [[nodiscard]] testing::Ended run(std::vector<std::string> all) const {
    all.insert(all.begin(), testing::program_path("hydroprint-worker"));
    return testing::run(all);
  }
  [[nodiscard]] testing::Ended calibrate(const std::vector<std::string>& more,
                                         const std::string& frames = "frames") const {
    std::vector<std::string> all = {"calibrate", "--frames", path(frames),      "--layout",
                                    layout,      "--mesh",   path("board.obj"), "--out",
                                    path("out"), "--json"};
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  }

  void SetUp() override {
    rig.lens = simulated_camera::drawn_lens(kCamera);
    const auto surface = testing::box({-60, -60, 0}, {60, 60, 10});
    write_obj(path("board.obj"), surface);
    Eigen::AlignedBox3d box;
    for (const auto& p : surface.points) box.extend(p);
    const Eigen::Vector3d middle = box.center();
    X_FO = Eigen::Translation3d(4, -3, 60) * testing::crooked(5 * kDegree, 0, 4) *
           Eigen::Translation3d(-middle);
    rig.gripper_mm = 60 + box.sizes().z() / 2;
    rig.more = {testing::body_of(surface, X_FO)};
  }
  void take_frames(int count) { write_frames(path("frames"), rig.frames(count, kCamera)); }

  testing::TemporaryFolder folder;
  testing::Rig rig;
  Pose X_FO;
  std::string layout = testing::source_path("deploy/rig_layout.toml.example");
};

}  // namespace hydroprint::calibrate
