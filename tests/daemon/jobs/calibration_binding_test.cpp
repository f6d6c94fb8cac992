#include "daemon/jobs/calibration_binding.h"

#include <gtest/gtest.h>

#include "daemon/jobs/calibration_report.h"
#include "hydroprint/v1/report.pb.h"

namespace hydroprint::daemon {
namespace {

using Why = std::vector<v1::Calibration::Staleness>;

TEST(Staleness, DependsOnAxisHomingAndDips) {
  const RigPlace then{true, true, 20, 1, 0};
  RigPlace now = then;
  EXPECT_EQ(staleness(then, now), Why{});
  now.axis_mm = 20.1;  // residual error of a move back to the same position
  EXPECT_EQ(staleness(then, now), Why{});
  now.axis_mm = 20.5;
  EXPECT_EQ(staleness(then, now), Why{v1::Calibration::MOVED});
  now = then;
  now.homings = 2;
  EXPECT_EQ(staleness(then, now), Why{v1::Calibration::HOMED});
  now = then;
  now.homed = false;
  EXPECT_EQ(staleness(then, now), Why{v1::Calibration::HOMED})
      << "the axis lost its reference, so it must be homed again";
  now = then;
  now.dips = 1;
  EXPECT_EQ(staleness(then, now), Why{v1::Calibration::DIPPED});
}

TEST(Staleness, IsUnknownWithoutARig) {
  EXPECT_EQ(staleness({}, {true, true, 5, 1, 1}), Why{});
  EXPECT_EQ(staleness({true, true, 5, 1, 1}, {}), Why{v1::Calibration::HOMED})
      << "the rig of the calibration is no longer configured";
}

TEST(CalibrationReport, ValuesThatNoCalibrationHasAreNamed) {
  v1::CalibrationFacts facts;
  const auto refusal = [&] {
    v1::Calibration out;
    const Status status = take_calibration(facts, out);
    return status
               ? "taken"
               : std::string(name_of(status.error().reason)) + ": " + full_message(status.error());
  };
  EXPECT_NE(refusal().find("pose.rotation_wxyz"), std::string::npos);
  for (const double x : {1.0, 0.0, 0.0, 0.0}) facts.mutable_pose()->add_rotation_wxyz(x);
  for (const double x : {0.0, 0.0, 1e9}) facts.mutable_pose()->add_translation_mm(x);
  EXPECT_NE(refusal().find("pose.translation_mm"), std::string::npos);
  facts.mutable_pose()->set_translation_mm(2, 40);
  EXPECT_NE(refusal().find("covariance"), std::string::npos);
  v1::CalibrationFacts::Uncertainty& uncertainty = *facts.mutable_uncertainty();
  for (int i = 0; i < 36; ++i) uncertainty.add_covariance_turn_rad_shift_mm(1);
  for (int i = 0; i < 3; ++i) uncertainty.add_about_mm(1);
  EXPECT_EQ(refusal(), "taken");
  facts.mutable_pose()->set_rotation_wxyz(1, 0.1);
  EXPECT_NE(refusal().find("WORKER_UNUSABLE"), std::string::npos) << "not a rotation";
}

}  // namespace
}  // namespace hydroprint::daemon
