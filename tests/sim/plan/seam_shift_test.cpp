#include "sim/plan/seam_shift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/value_of.h"

namespace hydroprint::plan {
namespace {

using Eigen::Vector3d;

/// A circle at a height, as straight segments.
std::vector<SeamSegment> circle(double radius_mm, double z_mm, int dip, int other) {
  constexpr int kParts = 720;
  std::vector<SeamSegment> out;
  const auto at = [&](int i) {
    const double angle = 2 * M_PI * i / kParts;
    return Vector3d(radius_mm * std::cos(angle), radius_mm * std::sin(angle), z_mm);
  };
  for (int i = 0; i < kParts; ++i) out.push_back({at(i), at(i + 1), dip, other});
  return out;
}

Context with_two_threads() {
  Context context;
  context.threads = 2;
  return context;
}

double shift(const std::vector<SeamSegment>& seam, const std::vector<SeamSegment>& from, int dip) {
  return testing::value_of(seam_shift_mm(seam, from, dip, with_two_threads()));
}

TEST(SeamShift, IsTheLargestDistanceOfParallelCircles) {
  const auto planned = circle(40, 0, 1, 2);
  EXPECT_LT(shift(planned, planned, 1), 1e-9);
  EXPECT_NEAR(shift(circle(40, 3, 1, 2), planned, 2), 3, 1e-9);
  EXPECT_NEAR(shift(circle(44, 3, 1, 2), planned, 1), 5, 1e-2);
}

TEST(SeamShift, OfATurnedCircleIsThatOfItsHighestPoint) {
  const double angle = 8 * M_PI / 180;
  auto turned = circle(40, 0, 1, 2);
  const Eigen::AngleAxisd turn(angle, Vector3d::UnitX());
  for (SeamSegment& segment : turned) segment = {turn * segment.from, turn * segment.to, 1, 2};
  // The nearest point of the planned circle is below it, and nearer to the middle by R (1 - cos).
  const double up = 40 * std::sin(angle), in = 40 * (1 - std::cos(angle));
  EXPECT_NEAR(shift(turned, circle(40, 0, 1, 2), 1), std::hypot(up, in), 0.02);
}

TEST(SeamShift, SeamsOfOtherDipsDoNotCount) {
  auto seam = circle(40, 0, 1, 2);
  const auto far = circle(40, 30, 2, 3);
  seam.insert(seam.end(), far.begin(), far.end());
  EXPECT_LT(shift(seam, circle(40, 0, 1, 2), 1), 1e-9);
  EXPECT_NEAR(shift(seam, circle(40, 0, 1, 2), 2), 30, 1e-9);
  EXPECT_EQ(shift(seam, {}, 4), 0) << "no seam of that dip";
  EXPECT_TRUE(std::isinf(shift(seam, {}, 1))) << "none was planned";
}

TEST(SeamShift, EndsWhenCancelled) {
  const auto seam = circle(40, 0, 1, 2);
  Context context;
  context.cancelled = [] { return true; };
  const auto out = seam_shift_mm(seam, seam, 1, context);
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, Code::kCancelled);
}

}  // namespace
}  // namespace hydroprint::plan
