// Measures the drift of the position of a camera with all its errors, moved by hand for 10 s, and
// the error of the fused surface. bench_sweep [CAMERAS [FRAMES]]: defaults 3 and 300.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "hardware/simulator/camera/lens.h"
#include "sim/mesh/read/read_model.h"
#include "sim/registration/shape.h"
#include "sim/sample/sample.h"
#include "sim/scan/sweep.h"
#include "tests/bench/figures.h"
#include "tests/support/depth_scene.h"
#include "tests/support/paths.h"
#include "tests/support/swept_camera.h"

namespace hydroprint::bench {
namespace {

using Eigen::Vector3d;
using testing::SweptCamera;

/// Space of the rig in the film frame: within the bars, from just below the water up.
const Eigen::AlignedBox3d kRig_F(Vector3d(-165, -210, -5), Vector3d(165, 210, 400));
constexpr double kOnObject_mm = 6;  ///< points within this distance belong to the object
constexpr double kLeastFrames = 3;

/// The tilted mug, or a ball if the mug's model is missing.
simulated_scene::Body hung() {
  const std::filesystem::path mug = testing::model_path("mug/mug.obj");
  const mesh::Surface surface =
      testing::surface_of(value_of(std::filesystem::exists(mug) ? mesh::read_model(mug, 10, {})
                                                                : sample::make_model("sphere80")));
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : surface.points) box.extend(p);
  Pose X_FO = testing::crooked(0.2, 0, 4);
  X_FO.translation() = Vector3d(4, -3, 60 + box.sizes().z() / 2) - X_FO.linear() * box.center();
  return testing::body_of(surface, X_FO);
}

double share_of(std::vector<double>& values, double share) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Results of the row, collected over all cameras.
struct Figures {
  std::vector<double> camera_mm, end_mm, end_deg, surface_mm, object_mm, seconds;
  std::size_t lost = 0, refused = 0;

  void add_path(const scan::Sweep& sweep, const SweptCamera& camera) {
    const std::vector<Pose>& X_WC = sweep.path.X_WC;
    for (std::size_t i = 0; i < X_WC.size(); ++i) {
      const Pose off = camera.X_FC(static_cast<int>(i)).inverse() * (camera.X_FC(0) * X_WC[i]);
      camera_mm.push_back(off.translation().norm());
      if (i + 1 < X_WC.size()) continue;
      end_mm.push_back(off.translation().norm());
      end_deg.push_back(Eigen::AngleAxisd(off.linear()).angle() * 180 / M_PI);
    }
  }

  void add_surface(const scan::Sweep& sweep, const SweptCamera& camera,
                   const simulated_scene::Body& object) {
    mesh::Model model;
    model.path = "object";
    model.vertices = object.mesh.points;
    model.triangles = object.mesh.triangles;
    const registration::Shape scene(camera.scene()), body(testing::surface_of(model));
    const double sigma_mm = scan::DepthNoise{}.sigma_mm(800);
    for (const Vector3d& p : sweep.volume.surface(kLeastFrames / (sigma_mm * sigma_mm)).points_mm) {
      const Vector3d p_F = camera.X_FC(0) * p;
      if (!kRig_F.contains(p_F)) continue;
      const double off_mm = (scene.closest(p_F).point_mm - p_F).norm();
      surface_mm.push_back(off_mm);
      if ((body.closest(p_F).point_mm - p_F).norm() < kOnObject_mm) object_mm.push_back(off_mm);
    }
  }

  [[nodiscard]] Json json() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return {{"refused", refused},
            {"lost", lost},
            {"camera_mm", share_of(camera_mm, 0.95)},
            {"camera_max_mm", share_of(camera_mm, 1)},
            {"end_mm", share_of(end_mm, 1)},
            {"end_deg", share_of(end_deg, 1)},
            {"surface_p50_mm", share_of(surface_mm, 0.5)},
            {"surface_mm", share_of(surface_mm, 0.95)},
            {"object_p50_mm", share_of(object_mm, 0.5)},
            {"object_mm", share_of(object_mm, 0.95)},
            {"seconds", share_of(seconds, 1)},
            {"memory_mib", static_cast<double>(usage.ru_maxrss) / 1024}};
  }
};

void run(int cameras, int count) {
  const simulated_scene::Body object = hung();
  Figures figures;
  for (int k = 0; k < cameras; ++k) {
    const SweptCamera camera({object}, static_cast<std::uint64_t>(4 + k));
    const std::vector<scan::DepthFrame> frames = camera.frames(count);
    std::vector<double> times_s;
    for (int i = 0; i < count; ++i)
      times_s.push_back(static_cast<double>(i) / simulated_camera::kRate_hz);
    const double begin_s = seconds_now();
    const auto sweep =
        scan::fuse_sweep({frames, times_s, {camera.lens()}, {}, {}}, testing::two_threads());
    figures.seconds.push_back(seconds_now() - begin_s);
    if (!sweep) {
      std::fprintf(stderr, "camera %d: %s\n", k, sweep.error().message.c_str());
      ++figures.refused;
      continue;
    }
    figures.lost += sweep->path.lost();
    figures.add_path(*sweep, camera);
    figures.add_surface(*sweep, camera, object);
  }
  print("sweep", figures.json());
}

}  // namespace
}  // namespace hydroprint::bench

int main(int argc, char** argv) {
  const int cameras = argc > 1 ? std::atoi(argv[1]) : 3;
  const int frames = argc > 2 ? std::atoi(argv[2]) : 300;
  hydroprint::bench::run(cameras, frames);
}
