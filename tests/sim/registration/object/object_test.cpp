// Poses of objects from scans, and motions that scans do not determine.
#include "sim/registration/object/object.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <filesystem>

#include "sim/mesh/read/read_model.h"
#include "sim/registration/film_frame/water_level.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/registration/limits.h"
#include "tests/support/depth_scene.h"
#include "tests/support/paths.h"

namespace hydroprint::registration {
namespace {

using testing::box;
using testing::crooked;
using testing::Rig;

/// The middle of the image, which shows the whole object and makes the tests faster.
constexpr testing::Window kMiddle{160, 100, 320, 240};

/// The board of the samples, without its picture.
mesh::Surface board() { return box({-60, -60, 0}, {60, 60, 10}); }

/// A body with three arms of different lengths. No rotation or reflection maps it to itself.
mesh::Surface tripod() {
  mesh::Surface all = box({-15, -15, -15}, {75, 15, 15});
  all = joined(std::move(all), box({-15, 15, -15}, {15, 55, 15}));
  return joined(std::move(all), box({-15, -15, 15}, {15, 15, 45}));
}

/// An object in the gripper, and the camera's view of it.
struct Hanging {
  Rig rig;
  ObjectTask task;
  Pose X_FO;
  testing::Window window = kMiddle;

  explicit Hanging(const mesh::Surface& surface, const Pose& off = crooked(6 * kDegree, 5, 3)) {
    task.surface = surface;
    Eigen::AlignedBox3d bounds;
    for (const auto& p : surface.points) bounds.extend(p);
    task.nominal_FO.translation() = Eigen::Vector3d(0, 0, 40 - bounds.min().z());
    rig.gripper_mm = task.nominal_FO.translation().z() + bounds.max().z() - 5;
    task.surroundings.gripper_from_mm = rig.gripper_mm - 10;
    task.surroundings.layout = testing::nominal_layout();
    hang(task.nominal_FO * off);
  }

  void hang(const Pose& pose) {
    X_FO = pose;
    rig.more = {testing::body_of(task.surface, X_FO)};
  }
  [[nodiscard]] FilmFrame frame() const {
    FilmFrame out;
    out.fit.X_CB = rig.X_CF();
    return out;
  }
  [[nodiscard]] scan::FusedFrame fused(std::vector<scan::DepthFrame> frames) const {
    for (auto& f : frames) f = testing::cropped(f, window);
    return scan::fuse(frames, {}, testing::two_threads()).value();
  }
  [[nodiscard]] scan::Cloud cloud(const scan::FusedFrame& f) const {
    const auto lens = testing::cropped(testing::lens_of(rig.lens), window);
    return scan::make_cloud(f, {lens}, {}, testing::two_threads()).value();
  }
  [[nodiscard]] Result<ObjectPose> find() const {
    const auto f = fused({rig.exact()});
    return find_object(cloud(f), f.mean, frame(), task, testing::two_threads());
  }
  [[nodiscard]] std::string reason() const {
    const auto pose = find();
    return pose ? "" : std::string(name_of(pose.error().reason)) + ": " + pose.error().message;
  }
};

double turn_rad(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

/// A direction from which all six motions of the tripod can be seen.
const simulated_scene::CameraStand kAside = testing::stand_at(800, 60 * kDegree, 0.6);

TEST(Object, ExactDepthsGiveTheExactPose) {
  Hanging hanging(tripod());
  hanging.rig.stand = kAside;
  const auto pose = hanging.find();
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_LT((pose->X_FO.inverse() * hanging.X_FO).translation().norm(), 0.1);
  EXPECT_LT(turn_rad(pose->X_FO, hanging.X_FO), 0.1 * kDegree);
  EXPECT_TRUE(pose->weak.empty());
  EXPECT_LT(pose->misfit_mm, 0.1);
}

TEST(Object, IsFoundInAnyPose) {
  const Hanging hanging(tripod(), crooked(110 * kDegree, 5, 8));
  const auto pose = hanging.find();
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_LT(turn_rad(pose->X_FO, hanging.X_FO), 0.2 * kDegree);
}

TEST(Object, AmbiguousBoardPosesResolveToTheNominalOne) {
  const Hanging hanging(board());
  const auto pose = hanging.find();
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_LT(turn_rad(pose->X_FO, hanging.X_FO), 0.3 * kDegree);
}

TEST(Object, ASpheresTurnsAreNamedAndDoNotCountAsErrors) {
  const Hanging hanging(testing::surface_of(sample::icosphere(50, 5)));
  const auto pose = hanging.find();
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_TRUE(pose->weak.empty()) << pose->weak.front();
  EXPECT_EQ(pose->symmetry.substr(0, 15), "any turn about ") << pose->symmetry;
  EXPECT_LT(turn_rad(pose->X_FO, hanging.task.nominal_FO), 0.01 * kDegree);
  EXPECT_LT((pose->X_FO.translation() - hanging.X_FO.translation()).norm(), 0.1);
  // No turn of a sphere moves its surface, so all of it is as accurate as its middle.
  const std::vector<Eigen::Vector3d> places{pose->centre_mm,
                                            pose->centre_mm + Eigen::Vector3d(50, 0, 0)};
  const auto error = error_at(places, pose->centre_mm, pose->covariance);
  EXPECT_LT(error[0], 0.5);
  EXPECT_LT(error[1], 0.5);
}

TEST(Object, CylinderDeterminesAllButTheRotationAboutItsAxis) {
  const Hanging hanging(testing::cylinder(40, 0, 90, 180));
  const auto pose = hanging.find();
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_TRUE(pose->weak.empty()) << pose->weak.front();
  EXPECT_EQ(pose->symmetry.substr(0, 23), "turn about the axis thr") << pose->symmetry;
  const Eigen::Vector3d axis = pose->X_FO.linear().col(2), truth = hanging.X_FO.linear().col(2);
  EXPECT_LT(std::acos(std::min(1.0, axis.dot(truth))), 0.1 * kDegree);
}

TEST(Object, UnitsOtherThanMillimetresAreNamed) {
  Hanging hanging(tripod());
  const mesh::Surface right = hanging.task.surface;
  const auto scaled = [&](double factor) {
    hanging.task.surface = right;
    for (auto& p : hanging.task.surface.points) p *= factor;
    return hanging.reason();
  };
  EXPECT_NE(scaled(1e-3).find("WRONG_UNITS"), std::string::npos);
  EXPECT_NE(scaled(1e-3).find("metres"), std::string::npos);
  EXPECT_NE(scaled(1 / 25.4).find("inches"), std::string::npos);
}

TEST(Object, MirroredMeshAndAnotherObjectAreRefused) {
  Hanging hanging(tripod());
  hanging.task.surface = mirrored(hanging.task.surface);
  EXPECT_EQ(hanging.reason().substr(0, 8), "MIRRORED");
  hanging.task.surface = testing::surface_of(sample::icosphere(45, 4));
  EXPECT_EQ(hanging.reason().substr(0, 15), "NOT_THIS_OBJECT");
}

TEST(Object, NoObjectOrTwoObjectsAreRefused) {
  Hanging hanging(tripod());
  const auto object = hanging.rig.more;
  hanging.rig.more.clear();
  EXPECT_EQ(hanging.reason().substr(0, 31), "NO_OBJECT: no object is in view");
  hanging.rig.more = object;
  hanging.rig.more.push_back(
      testing::body_of(box({-110, -60, 40}, {-70, 0, 80}), Pose::Identity()));
  EXPECT_EQ(hanging.reason().substr(0, 11), "TWO_OBJECTS");
}

/// An L of 50 x 30 x 40 mm upside down: its plate is on top, its leg hangs from one end. The camera
/// looks steeply from above, so it sees little but the top.
mesh::Surface bracket_upside_down() {
  return joined(box({-30, -15, -12}, {20, 15, 0}), box({8, -15, -40}, {20, 15, -12}));
}

/// Hangs the bracket below the lower end of the gripper, and returns what the camera with errors
/// finds.
std::string bracket_reason(double below_mm) {
  Hanging hanging(tripod());
  hanging.task.surface = bracket_upside_down();
  hanging.rig.gripper_mm = 130;
  hanging.task.surroundings.gripper_from_mm = hanging.rig.gripper_mm - 5;
  hanging.task.nominal_FO = Pose(Eigen::Translation3d(0, 0, hanging.rig.gripper_mm - below_mm));
  hanging.hang(hanging.task.nominal_FO);
  const auto f = hanging.fused(hanging.rig.frames(8, 1));
  const auto pose =
      find_object(hanging.cloud(f), f.mean, hanging.frame(), hanging.task, testing::two_threads());
  return pose ? "" : std::string(name_of(pose.error().reason)) + ": " + pose.error().message;
}

TEST(Object, SmallObjectAtTheGripperIsToBeHungLower) {
  EXPECT_EQ(bracket_reason(20), "");
  const std::string reason = bracket_reason(0);
  EXPECT_EQ(reason.substr(0, 9), "NO_OBJECT");
  EXPECT_NE(reason.find("too little of the object"), std::string::npos) << reason;
  EXPECT_NE(reason.find("Above 125 mm, all within 28 mm"), std::string::npos) << reason;
  EXPECT_NE(reason.find("Hang it lower"), std::string::npos) << reason;
}

TEST(Object, HalfOutOfViewIsReported) {
  Hanging hanging(tripod());
  hanging.window.u += 160;  // the window shows only a part of the object
  const auto pose = hanging.find();
  if (!pose) return;  // refusing the scan is valid, too
  ASSERT_FALSE(pose->warnings.empty());
  EXPECT_EQ(pose->warnings[0].code, WarningCode::OBJECT_PARTLY_OUT_OF_VIEW);
}

TEST(Object, NormalisedErrorsStayWithinTheirEllipsoid) {
  Hanging hanging(tripod());
  // From here, the camera sees three sides of the object for every tilt.
  hanging.rig.stand = testing::stand_at(800, 50 * kDegree, 0.75);
  int within = 0;
  constexpr std::uint32_t kSeeds = 20;
  const Shape shape(hanging.task.surface);
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    hanging.hang(hanging.task.nominal_FO * crooked(10 * kDegree, 5, seed + 50));
    const auto cloud = hanging.cloud(hanging.fused(hanging.rig.frames(8, seed)));
    const auto points = object_points(cloud, hanging.frame(), hanging.task.surroundings).all;
    const Pose truth = hanging.rig.X_CF() * hanging.X_FO;
    const auto fit = fit_pose(shape, points, cloud.camera, truth * crooked(2 * kDegree, 2, seed),
                              truth, {}, testing::two_threads());
    ASSERT_TRUE(fit) << fit.error().message;
    ASSERT_TRUE(fit->weak.empty());
    const Vector6 off = twist_between(fit->X_CB, truth, fit->centre_mm);
    const double square = off.dot(fit->covariance.inverse() * off);
    within += square < kSquare95 ? 1 : 0;
    RecordProperty("square_" + std::to_string(seed), std::to_string(square));
  }
  EXPECT_GE(within, static_cast<int>(0.9 * kSeeds));
}

TEST(Object, RealModelsAreFound) {
  for (const auto& [file, scale] :
       {std::pair{"mug/mug.obj", 10.0}, std::pair{"head/LeePerrySmith_converted.obj", 15.0}}) {
    const std::filesystem::path path = testing::model_path(file);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " does not exist";
    const auto model = mesh::read_model(path, scale, {});
    ASSERT_TRUE(model);
    const Hanging hanging(testing::surface_of(*model));
    const auto pose = hanging.find();
    ASSERT_TRUE(pose) << file << ": " << pose.error().message;
    EXPECT_LT((pose->X_FO * pose->fit.X_CB.inverse() * pose->fit.centre_mm -
               hanging.X_FO * pose->fit.X_CB.inverse() * pose->fit.centre_mm)
                  .norm(),
              0.3)
        << file;
    if (pose->weak.empty()) {
      EXPECT_LT(turn_rad(pose->X_FO, hanging.X_FO), 0.3 * kDegree) << file;
    }
  }
}

TEST(WaterLevel, MatchesTheWaterWithinItsStatedUncertainty) {
  Hanging hanging(tripod());
  const auto cloud = hanging.cloud(hanging.fused(hanging.rig.frames(12, 77)));
  FilmFrame frame = hanging.frame();
  frame.fit.X_CB.translation() += frame.fit.X_CB.linear() * Eigen::Vector3d(0, 0, 2.5);
  const auto level = water_level(cloud, frame, {100, 140});
  ASSERT_TRUE(level) << level.error().message;
  EXPECT_NEAR(level->z_mm, -2.5, 4 * level->sigma_mm);
  EXPECT_LT(level->sigma_mm, 0.1);
}

}  // namespace
}  // namespace hydroprint::registration
