// Which of several fits explains a scan.
#include "sim/registration/object/best_fit.h"

#include <gtest/gtest.h>

#include <array>

namespace hydroprint::registration {
namespace {

/// A good fit of a board: most of 1500 points lie on it, with a misfit of 0.02 mm.
constexpr FitQuality kGood{1500, 1450, 0.020, 40, 0.01, 0.5, 0.10};

FitQuality changed(double points, double misfit_mm, double turn_rad) {
  FitQuality out = kGood;
  out.points = points;
  out.misfit_mm = misfit_mm;
  out.mismatch += (misfit_mm - kGood.misfit_mm) / 10;
  out.distance_mm += 0.01;
  out.turn_rad = turn_rad;
  return out;
}

/// A fit that slid along the board by some mm still has most points within 4 mm of it.
TEST(BestFit, FewerPointsOrALargerMisfitLoseAlsoNearTheNominalPose) {
  EXPECT_EQ(best_fit(std::array{changed(1350, 0.105, 0.02), kGood}), 1U) << "both";
  EXPECT_EQ(best_fit(std::array{changed(1450, 0.105, 0.02), kGood}), 1U) << "the misfit";
  EXPECT_EQ(best_fit(std::array{changed(1350, 0.020, 0.02), kGood}), 1U) << "the points";
}

TEST(BestFit, WithinNoiseTheSmallestRotationWins) {
  EXPECT_EQ(best_fit(std::array{kGood, changed(1440, 0.024, 0.02)}), 1U);
  EXPECT_EQ(best_fit(std::array{kGood, changed(1440, 0.024, 1.57)}), 0U);
}

TEST(BestFit, WithoutNoiseTinyMisfitsDoNotDecide) {
  FitQuality exact = kGood, turned = kGood;
  exact.points = turned.points = 1500;
  exact.misfit_mm = 1e-6;
  turned.misfit_mm = 1e-4;
  turned.turn_rad = 0.02;
  EXPECT_EQ(best_fit(std::array{exact, turned}), 1U);
}

/// The camera sees through a part of the surface.
TEST(BestFit, AMismatchedFitNeverWins) {
  FitQuality through = changed(1450, 0.02, 0.01);
  through.mismatch += 0.1;
  through.distance_mm = 0.1;
  EXPECT_EQ(best_fit(std::array{through, kGood}), 1U);
}

}  // namespace
}  // namespace hydroprint::registration
