#include "client/loop/draws.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <sstream>

#include "sim/registration/camera/calibration_board.h"
#include "sim/sample/sample.h"

namespace hydroprint::loop {
namespace {

constexpr double kHeldTilt_deg = 30;  // tilt of the paper's board

/// Random numbers in [-1, 1) that are identical on every platform: the distributions of the
/// standard library differ between implementations.
class Draws {
 public:
  Draws(std::uint32_t seed, int index, std::uint32_t purpose) {
    std::seed_seq words{seed, static_cast<std::uint32_t>(index), purpose};
    random_.seed(words);
  }
  double even() { return 2 * (static_cast<double>(random_()) / 4294967296.0) - 1; }

 private:
  std::mt19937 random_;
};

/// Returns the object's pose in the gripper: rotated by `turn`, with its bounding box centred below
/// the gripper and the top of the box at the gripper's lower end.
Pose hung(const Body& body, const Eigen::Matrix3d& turn) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : body.points) box.extend(turn * p);
  Pose out = Pose::Identity();
  out.linear() = turn;
  out.translation() = Eigen::Vector3d(-box.center().x(), -box.center().y(), -box.max().z());
  return out;
}

double lowest_mm(const Body& body, const Pose& X_AO) {
  double out = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : body.points) out = std::min(out, (X_AO * p).z());
  return out;
}

}  // namespace

Result<Body> make_body(const std::string& name) {
  Body out{name, Eigen::Matrix3d::Identity(), name == "sphere80", {}};
  if (name != "board" && name != "sphere80") {
    return fail(Code::kInvalidArgument,
                fmt::format("unknown sample '{}'; use board or sphere80", name));
  }
  if (name == "board") {
    // Rotates the board so that the camera, at the near side, sees two upright faces. From the
    // upper face alone, the position of the board along that face cannot be measured.
    const Eigen::AngleAxisd tilt(-kHeldTilt_deg * kDegree, Eigen::Vector3d::UnitX());
    const Eigen::AngleAxisd about(std::numbers::pi / 4, Eigen::Vector3d::UnitZ());
    out.nominal_turn = (tilt * about).matrix();
  }
  HP_ASSIGN_OR_RETURN(const mesh::Model model, sample::make_model(name));
  out.points = model.vertices;
  return out;
}

Truth draw(const Body& body, std::uint32_t seed, int index) {
  Draws draws(seed, index, 0x10090u);
  const auto even = [&] { return draws.even(); };
  const Eigen::Vector3d axis(even(), even(), even());
  const double drawn = kMostTilt_deg * kDegree * even();
  const double angle = body.is_round ? 0 : drawn;
  const Eigen::Matrix3d crooked = Eigen::AngleAxisd(angle, axis.normalized()).matrix();
  Truth out;
  out.X_GO = hung(body, crooked * body.nominal_turn);
  out.X_GO.translation() += Eigen::Vector3d(kMostShift_mm * even(), kMostShift_mm * even(), 0);
  const double towards = std::numbers::pi * even();
  const double slope = std::tan(kMostSlope_deg * kDegree) * even();
  out.slope = slope * Eigen::Vector2d(std::cos(towards), std::sin(towards));
  out.film_mm = kMostFilm_mm / std::numbers::sqrt2 * Eigen::Vector2d(even(), even());
  out.printer_scale = 1 + kMostScale * even();
  return out;
}

Pose nominal_pose(const Body& body) { return hung(body, body.nominal_turn); }

double height_mm(const Body& body, const Truth& truth, double gripper_mm) {
  return lowest_mm(body, truth.X_GO) + gripper_mm;
}

Pose pose_at_contact(const Body& body, const Truth& truth, double gripper_mm) {
  const double down_mm = height_mm(body, truth, gripper_mm);
  Pose out = truth.X_GO;
  out.translation().head<2>() += down_mm * truth.slope;
  out.translation().z() += gripper_mm - down_mm;
  return out;
}

Pose held_board(std::uint32_t seed, int index) {
  Draws draws(seed, index, 0xb0a4du);
  const double towards = std::numbers::pi * draws.even(), tilt = (index % 3) * 15 * kDegree;
  const Eigen::Vector3d about(std::cos(towards), std::sin(towards), 0);
  const Eigen::Vector3d facing(1, -1, -1);
  Pose out = Pose::Identity();
  out.linear() = Eigen::AngleAxisd(tilt, about).matrix() * facing.asDiagonal() *
                 Eigen::AngleAxisd(0.2 * draws.even(), Eigen::Vector3d::UnitZ()).matrix();
  const double away_mm = 520 + 90 * (index % 6), aside = 0.5 - 126 / away_mm;
  out.translation() = away_mm * Eigen::Vector3d(aside * std::cos(2.4 * index),
                                                0.66 * aside * std::sin(2.4 * index), 1);
  return out;
}

std::string board_obj() {
  const mesh::Surface board = registration::calibration_board();
  std::ostringstream out;
  out.precision(17);
  for (const Eigen::Vector3d& p : board.points)
    out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const Eigen::Vector3i& t : board.triangles)
    out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return out.str();
}

std::string pose_json(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  return nlohmann::ordered_json{{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
                                {"translation_mm", {t.x(), t.y(), t.z()}}}
             .dump() +
         "\n";
}

}  // namespace hydroprint::loop
