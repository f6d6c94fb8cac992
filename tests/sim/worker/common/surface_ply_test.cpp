#include "sim/worker/common/surface_ply.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/content.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/value_of.h"

namespace hydroprint::worker {
namespace {

using Eigen::Vector3d;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A tetrahedron in a plan of two dips.
pipeline::Plan small_plan() {
  pipeline::Plan out;
  out.surface.points = {{0, 0, 0}, {30, 0, 0.25}, {0, 20, -1e-7}, {0, 0, 10}};
  out.surface.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  out.dips.resize(2);
  out.dips[0].map.stretch = {1, 1.25, kNone, 3};
  out.dips[1].map.stretch = {kNone, 2, 1.5, 1};
  out.dips[0].map.least_stretch = {1, 0.75, kNone, 0.5};
  out.dips[1].map.least_stretch = {kNone, 1, 0.5, 1};
  out.dip_at = {1, 1, 2, 2};
  out.weights_at = {{1, 0.75, 0, 0}, {0, 0.25, 1, 1}};
  return out;
}

class PlanPlyFile : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(write_plan(file, small_plan())); }

  /// Writes other bytes and reads them as a plan of two dips.
  Result<PlanSurface> read(const std::string& bytes) {
    folder.write("plan.ply", bytes);
    return read_plan_surface(file, 2);
  }

  testing::TemporaryFolder folder;
  std::filesystem::path file = folder.path() / "plan.ply";
};

TEST_F(PlanPlyFile, IsReadAsItWasWritten) {
  const auto plan = small_plan();
  const PlanSurface found = testing::value_of(read_plan_surface(file, 2));
  EXPECT_EQ(found.points, plan.surface.points);
  EXPECT_EQ(found.triangles, plan.surface.triangles);
  ASSERT_EQ(found.stretch.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < 4; ++i) {
      const double written = plan.dips[k].map.stretch[i];
      EXPECT_TRUE(std::isnan(written) ? std::isnan(found.stretch[k][i])
                                      : found.stretch[k][i] == written);
    }
  }
}

TEST_F(PlanPlyFile, OfAnotherNumberOfDipsIsRefused) {
  for (const std::size_t dips : {1, 3, 12}) {
    const auto found = read_plan_surface(file, dips);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, Code::kInvalidArgument);
    EXPECT_NE(found.error().message.find("plan.ply"), std::string::npos);
  }
}

TEST_F(PlanPlyFile, EveryTruncationIsRefused) {
  const std::string bytes = testing::content(file);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(read(bytes.substr(0, size))) << size;
}

TEST_F(PlanPlyFile, DamagedBytesAreRefusedOrGiveUsableNumbers) {
  const std::string bytes = testing::content(file);
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = bytes;
    damaged[random() % bytes.size()] = static_cast<char>(random());
    const auto found = read(damaged);
    if (!found) continue;
    for (const Vector3d& point : found->points) EXPECT_TRUE(point.allFinite());
    for (const Eigen::Vector3i& t : found->triangles) {
      EXPECT_GE(t.minCoeff(), 0);
      EXPECT_LT(t.maxCoeff(), 4);
    }
    for (const auto& of_dip : found->stretch) {
      for (const double s : of_dip) EXPECT_TRUE(std::isnan(s) || s >= 0);
    }
  }
}

TEST(SurfaceMapFile, HasTheFlagsOfAFaceAfterItsCorners) {
  const testing::TemporaryFolder folder;
  const mesh::Surface surface = small_plan().surface;
  const std::vector<double> none(4, kNone);
  const flow::SurfaceMap map{std::vector<Eigen::Vector2d>(4, {kNone, kNone}), none, none, none, {}};
  const std::filesystem::path file = folder.path() / "surface_map.ply";
  ASSERT_TRUE(write_surface_map(file, surface, map, {0, 1, 24, 63}));
  const std::string bytes = testing::content(file);
  EXPECT_NE(bytes.find("vertex_indices\nproperty uchar flags\nend_header\n"), std::string::npos);
  EXPECT_EQ(bytes.size(), bytes.find("end_header\n") + 11 + 4 * 9 * 8 + 4 * 14);
  const std::string faces = bytes.substr(bytes.size() - 4 * 14);
  for (std::size_t t = 0; t < 4; ++t) {
    EXPECT_EQ(faces[14 * t], 3);
    EXPECT_EQ(faces[14 * t + 1], surface.triangles[t][0]);
  }
  EXPECT_EQ((std::vector<int>{faces[13], faces[27], faces[41], faces[55]}),
            (std::vector<int>{0, 1, 24, 63}));
}

}  // namespace
}  // namespace hydroprint::worker
