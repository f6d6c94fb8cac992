#include "daemon/jobs/calibration_binding.h"

#include <gtest/gtest.h>

#include "daemon/jobs/calibration_file.h"

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

TEST(CalibrationFile, MissingAndInvalidKeysAreNamed) {
  const auto refusal = [](const std::string& json) {
    v1::Calibration out;
    const Status status = read_calibration(json, out);
    return status ? "taken" : status.error().reason + ": " + status.error().message;
  };
  EXPECT_NE(refusal("{}").find("/pose/rotation_wxyz/0"), std::string::npos);
  EXPECT_NE(refusal("no json").find("WORKER_UNUSABLE"), std::string::npos);
  EXPECT_NE(refusal(R"({"pose":{"rotation_wxyz":[1,0,0,0],"translation_mm":[0,0,1e9]}})")
                .find("/pose/translation_mm/2"),
            std::string::npos);
}

}  // namespace
}  // namespace hydroprint::daemon
