// Measures the accuracy of poses from depth frames with all camera errors, and checks their stated
// covariance. bench_calibrate [POSES [FRAMES]]: defaults 200 and 60.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <tuple>

#include "sim/mesh/read/read_model.h"
#include "sim/registration/camera/calibrate_camera.h"
#include "sim/registration/camera/calibration_board.h"
#include "sim/registration/object/object.h"
#include "sim/sample/sample.h"
#include "tests/bench/figures.h"
#include "tests/support/depth_scene.h"
#include "tests/support/paths.h"

namespace hydroprint::bench {
namespace {

using registration::Matrix6;
using registration::Vector6;
using std::numbers::pi;
using testing::crooked;

constexpr double kDegree = pi / 180;
constexpr int kPosesPerCamera = 4;
constexpr int kViews = 12, kFramesPerView = 30, kFramesForSteps = 10;

struct Body {
  std::string name;
  mesh::Surface surface;
};

/// A camera with its own lens and noise, and its calibration.
struct Camera {
  std::uint64_t seed;
  simulated_camera::Lens truth;
  registration::CameraCalibration calibration;
};

double even(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
}

std::uint32_t seed_from(std::mt19937& random) { return static_cast<std::uint32_t>(random()); }

std::vector<Body> bodies() {
  std::vector<Body> out;
  for (const char* kind : {"board", "sphere80"})
    out.push_back({kind, testing::surface_of(value_of(sample::make_model(kind)))});
  for (const auto& [name, file, scale] :
       {std::tuple{"mug", "mug/mug.obj", 10.0},
        std::tuple{"head", "head/LeePerrySmith_converted.obj", 15.0}}) {
    const std::filesystem::path path = testing::model_path(file);
    if (std::filesystem::exists(path))
      out.push_back({name, testing::surface_of(value_of(mesh::read_model(path, scale, {})))});
  }
  return out;
}

/// Pose of a handheld board in the i-th view: all over the image, near and far, differently tilted.
Pose held(int i, std::mt19937& random) {
  const double towards = even(random, 0, 2 * pi), tilt = (i % 3) * 15 * kDegree;
  const Eigen::Vector3d about(std::cos(towards), std::sin(towards), 0);
  Pose X_CB = Pose::Identity();
  X_CB.linear() = Eigen::AngleAxisd(tilt, about).matrix() *
                  Eigen::Vector3d(1, -1, -1).asDiagonal() *
                  Eigen::AngleAxisd(even(random, -0.2, 0.2), Eigen::Vector3d::UnitZ()).matrix();
  // `aside` keeps the board inside the image.
  const double away_mm = 520 + 90 * (i % 6), aside = 0.5 - 126 / away_mm;
  X_CB.translation() =
      away_mm * Eigen::Vector3d(aside * std::cos(2.4 * i), 0.66 * aside * std::sin(2.4 * i), 1);
  return X_CB;
}

/// Calibrates a camera as calibrate-camera does.
Camera draw_camera(std::mt19937& random) {
  Camera out{seed_from(random), {}, {}};
  out.truth = simulated_camera::drawn_lens(out.seed);
  testing::Rig rig;
  rig.lens = out.truth;
  rig.furnished = false;
  const auto frames = [&](int view, int count) {
    std::mt19937 hand(out.seed + static_cast<std::uint32_t>(view));
    rig.more = {testing::body_of(registration::calibration_board(),
                                 rig.X_CF().inverse() * held(view, hand))};
    return rig.frames(count, out.seed, kFramesPerView * view);
  };
  scan::DepthCounts counts;
  for (int i = 0; i < kViews; ++i) counts.add(frames(i, kFramesForSteps));
  const auto steps = scan::find_depth_steps(counts);
  std::vector<scan::FusedFrame> views;
  for (int i = 0; i < kViews; ++i)
    views.push_back(value_of(scan::fuse(frames(i, kFramesPerView), {}, steps, two_threads())));
  out.calibration = value_of(registration::calibrate_camera(
      views, registration::calibration_board(), scan::Lens{}, {}, two_threads()));
  const scan::Lens::Vector off =
      out.calibration.lens.parameters() - testing::lens_of(out.truth).parameters();
  std::fprintf(stderr, "lens: chi2 %.1f with 9 degrees of freedom, residuals %.2f sigmas rms\n",
               off.dot(out.calibration.covariance.ldlt().solve(off)), out.calibration.rms_sigmas);
  return out;
}

/// Results of a benchmark row, collected over poses.
struct Figures {
  std::vector<double> film_mm, film_deg, seen_mm, object_mm, object_deg, seconds;
  int film_within = 0, object_within = 0, refused = 0;

  void add(const Figures& other) {
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(film_mm, other.film_mm);
    append(film_deg, other.film_deg);
    append(seen_mm, other.seen_mm);
    append(object_mm, other.object_mm);
    append(object_deg, other.object_deg);
    append(seconds, other.seconds);
    film_within += other.film_within;
    object_within += other.object_within;
    refused += other.refused;
  }
};

double p95(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(values.size()))) - 1];
}

Json json_of(const Figures& f) {
  const auto share = [](int within, std::size_t of) {
    return of == 0 ? Json() : Json(static_cast<double>(within) / static_cast<double>(of));
  };
  return {{"poses", f.film_mm.size() + static_cast<std::size_t>(f.refused)},
          {"refused", f.refused},
          {"film_mm", p95(f.film_mm)},
          {"film_deg", p95(f.film_deg)},
          {"film_seen_mm", p95(f.seen_mm)},
          {"object_mm", p95(f.object_mm)},
          {"object_deg", p95(f.object_deg)},
          {"film_within", share(f.film_within, f.film_mm.size())},
          {"object_within", share(f.object_within, f.object_mm.size())},
          {"seconds", p95(f.seconds)}};
}

/// Returns a basis (columns) of the twists that the scan determines. `scale` converts a twist to mm
/// of surface motion.
Eigen::MatrixXd told_directions(const registration::PoseFit& fit, const Vector6& scale) {
  const auto weak = static_cast<Eigen::Index>(fit.weak.size());
  Eigen::MatrixXd all(6, weak + 6);
  for (Eigen::Index k = 0; k < weak; ++k)
    all.col(k) = scale.cwiseProduct(fit.weak[static_cast<std::size_t>(k)].twist);
  all.rightCols(6).setIdentity();
  const Eigen::MatrixXd orthogonal = Eigen::HouseholderQR<Eigen::MatrixXd>(all).householderQ();
  return orthogonal.rightCols(6 - weak);
}

/// 95 % quantiles of chi-square by degrees of freedom.
constexpr std::array kSquare95{0.0, 3.841, 5.991, 7.815, 9.488, 11.070, 12.592};

/// Error of a pose along the motions that the scan determines, in the camera frame. `square` is
/// its squared Mahalanobis distance.
struct Told {
  double mm = 0, deg = 0, square = 0;
  std::size_t directions = 6;

  [[nodiscard]] bool is_within() const { return square < kSquare95.at(directions); }
};

Told told(const Vector6& twist, const Matrix6& covariance, const registration::PoseFit& fit,
          double length_mm) {
  Vector6 scale;
  scale << Eigen::Vector3d::Constant(length_mm), Eigen::Vector3d::Ones();
  const Eigen::MatrixXd directions = told_directions(fit, scale);
  const Eigen::VectorXd along = directions.transpose() * scale.cwiseProduct(twist);
  const Matrix6 scaled = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Vector6 left = (directions * along).cwiseQuotient(scale);
  const Eigen::MatrixXd among = directions.transpose() * scaled * directions;
  return {left.tail<3>().norm(), left.head<3>().norm() / kDegree,
          along.dot(among.ldlt().solve(along)), static_cast<std::size_t>(directions.cols())};
}

/// A tilted body in front of a randomly placed camera.
struct Scene {
  testing::Rig rig;
  registration::ObjectTask task;
  Pose X_FO = Pose::Identity(), nominal_CF = Pose::Identity();
};

Scene draw_scene(const Body& body, const Camera& camera, std::mt19937& random) {
  Scene out;
  out.rig.lens = camera.truth;
  out.rig.stand = testing::stand_at(800, even(random, 56, 64) * kDegree, even(random, -0.3, 0.3));
  out.nominal_CF = out.rig.X_CF() * crooked(10 * kDegree, 20, seed_from(random));
  Eigen::AlignedBox3d bounds;
  for (const auto& p : body.surface.points) bounds.extend(p);
  out.task.surface = body.surface;
  const Eigen::Vector3d middle = bounds.center();
  const Eigen::Vector3d down(-middle.x(), -middle.y(), 35 - bounds.min().z());
  out.task.nominal_FO.translation() = down;
  const Pose off = crooked(even(random, 0, 8) * kDegree, 5, seed_from(random));
  out.X_FO =
      out.task.nominal_FO * Eigen::Translation3d(middle) * off * Eigen::Translation3d(-middle);
  out.rig.gripper_mm = down.z() + bounds.max().z() - 8;
  out.rig.more = {testing::body_of(body.surface, out.X_FO)};
  out.task.surroundings.gripper_from_mm = out.rig.gripper_mm - 12;
  out.task.surroundings.layout = testing::nominal_layout();
  return out;
}

/// Returns the RMS error of the film coordinates of points that this camera sees around the film.
/// The errors of film frame and lens, which are strongly correlated, partly cancel in it.
double seen_error_mm(const Scene& scene, const Camera& camera, const Pose& X_CF) {
  const scan::Lens truth = testing::lens_of(camera.truth);
  double squares = 0, count = 0;
  for (const double x : {-80.0, 0.0, 80.0}) {
    for (const double y : {-110.0, 0.0, 110.0}) {
      for (const double z : {0.0, 50.0, 100.0}) {
        const Eigen::Vector3d p_C = scene.rig.X_CF() * Eigen::Vector3d(x, y, z);
        const Eigen::Vector2d pixel = truth.project(p_C);
        const Eigen::Vector3d seen_C =
            camera.calibration.lens.point(pixel.x(), pixel.y(), p_C.z() / truth.depth_scale);
        squares += (X_CF.inverse() * seen_C - Eigen::Vector3d(x, y, z)).squaredNorm();
        ++count;
      }
    }
  }
  return std::sqrt(squares / count);
}

/// The result of a calibration from frames; without values if it is refused.
struct Outcome {
  std::optional<registration::FilmFrame> frame;
  std::optional<registration::ObjectPose> pose;
  std::string error;
  double seconds = 0;
};

Outcome calibrate(const Scene& scene, const Camera& camera,
                  const std::vector<scan::DepthFrame>& frames) {
  Outcome out;
  const auto start = std::chrono::steady_clock::now();
  const Context context = two_threads();
  const auto fused = value_of(scan::fuse(frames, {}, context));
  const auto cloud = value_of(scan::make_cloud(fused, camera.calibration, {}, context));
  auto frame = registration::find_film_frame(cloud, scene.task.surroundings.layout,
                                             scene.nominal_CF, context);
  if (frame) {
    auto pose = registration::find_object(cloud, fused.mean, *frame, scene.task, context);
    out.frame = std::move(*frame);
    if (pose)
      out.pose = std::move(*pose);
    else
      out.error = pose.error().message;
  } else {
    out.error = frame.error().message;
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  out.seconds = taken.count();
  return out;
}

void measure(const Body& body, const Camera& camera, int frames, std::uint32_t seed,
             Figures& figures) {
  std::mt19937 random(seed);
  const Scene scene = draw_scene(body, camera, random);
  const Outcome found = calibrate(scene, camera, scene.rig.frames(frames, camera.seed));
  if (!found.error.empty()) {
    ++figures.refused;
    std::fprintf(stderr, "%s %u: %s\n", body.name.c_str(), seed, found.error.c_str());
    return;
  }
  figures.seconds.push_back(found.seconds);
  const auto& fit = found.frame->fit;
  const Matrix6 by_camera = fit.camera_gain * fit.camera_gain.transpose();
  const Told film = told(registration::twist_between(fit.X_CB, scene.rig.X_CF(), fit.centre_mm),
                         fit.covariance + by_camera, fit, 1);
  figures.film_mm.push_back(film.mm);
  figures.film_deg.push_back(film.deg);
  figures.seen_mm.push_back(seen_error_mm(scene, camera, fit.X_CB));
  figures.film_within += film.is_within() ? 1 : 0;
  const auto& pose = *found.pose;
  const Matrix6 turn = registration::turned(fit.X_CB.linear());
  const Told object =
      told(turn * registration::twist_between(pose.X_FO, scene.X_FO, pose.centre_mm),
           turn * pose.covariance * turn.transpose(), pose.fit,
           registration::Shape(body.surface).radius_mm());
  figures.object_mm.push_back(object.mm);
  figures.object_deg.push_back(object.deg);
  figures.object_within += object.is_within() ? 1 : 0;
  std::fprintf(
      stderr,
      "%-8s %3u: film %.3f mm %.3f deg chi2 %5.1f, as seen %.3f mm; object %.3f mm %.3f deg chi2 "
      "%5.1f of %zu; misfit %.3f mm, on %.3f, through %.3f; %.1f s\n",
      body.name.c_str(), seed, film.mm, film.deg, film.square, figures.seen_mm.back(), object.mm,
      object.deg, object.square, object.directions, pose.misfit_mm, pose.on_share,
      pose.sight.through, found.seconds);
}

int run(int poses, int frames) {
  const auto all = bodies();
  std::map<std::string, Figures> rows;
  std::optional<Camera> camera;
  for (int i = 0; i < poses; ++i) {
    std::mt19937 random(static_cast<std::uint32_t>(1000 + i));
    if (i % kPosesPerCamera == 0) camera = draw_camera(random);
    const Body& body = all[static_cast<std::size_t>(i) % all.size()];
    measure(body, *camera, frames, static_cast<std::uint32_t>(i), rows[body.name]);
  }
  Figures pooled;
  for (const auto& [name, figures] : rows) {
    print("calibrate-" + name, json_of(figures));
    pooled.add(figures);
  }
  print("calibrate", json_of(pooled));
  return 0;
}

}  // namespace
}  // namespace hydroprint::bench

int main(int argc, char** argv) {
  const int poses = argc > 1 ? std::atoi(argv[1]) : 200;
  const int frames = argc > 2 ? std::atoi(argv[2]) : 60;
  return hydroprint::bench::run(poses, frames);
}
