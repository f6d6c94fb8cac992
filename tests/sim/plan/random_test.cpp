#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "sim/plan/blend.h"
#include "sim/plan/borders.h"
#include "sim/plan/facets.h"
#include "sim/plan/pieces.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/plan/fields.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::plan {
namespace {

/// Waves in random directions; each film ends at a random plane.
Stretch random_stretch(const mesh::Surface& surface, int dips, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::vector<std::function<double(const Eigen::Vector3d&)>> fields;
  for (int k = 0; k < dips; ++k) {
    const Eigen::Vector3d wave =
        0.15 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    const Eigen::Vector3d ripple =
        0.5 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    const Eigen::Vector3d end =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const double offset = 8 + 6 * normal(random);
    fields.emplace_back([=](const Eigen::Vector3d& p) {
      if (end.dot(p) > offset) return std::numeric_limits<double>::infinity();
      return 4 + std::sin(wave.dot(p) + k) + 0.3 * std::sin(ripple.dot(p));
    });
  }
  return testing::stretch_of(surface, fields);
}

class RandomBlend : public ::testing::TestWithParam<int> {
 protected:
  RandomBlend() : random_(static_cast<unsigned>(GetParam())) {
    stretch_ = random_stretch(surface_, 1 + GetParam() % 12, random_);
  }

  std::mt19937 random_;
  mesh::Surface surface_ = testing::surface_of(sample::icosphere(20, 3), 3);
  Stretch stretch_;
};

TEST_P(RandomBlend, SumsToOneWithinTheReach) {
  const auto regions = make_regions(surface_, stretch_, {}, {}).value();
  const auto blend = BlendWeights::create(surface_, regions, 5, {}).value();
  for (const auto& point : testing::random_points(surface_, 3000, 11)) {
    const auto weights = blend.at(point.triangle, point.barycentric);
    double sum = 0;
    bool is_reached = false;
    for (int dip = 1; dip <= regions.dips; ++dip) {
      const double weight = weights[std::size_t(dip - 1)];
      const bool reaches = regions.fragments.reaches(dip, point.triangle);
      is_reached = is_reached || reaches;
      sum += weight;
      EXPECT_GE(weight, 0);
      if (!reaches) {
        EXPECT_EQ(weight, 0);
      }
    }
    EXPECT_NEAR(sum, is_reached ? 1 : 0, 1e-6);
  }
}

TEST_P(RandomBlend, AgreesOnBothSidesOfAnEdge) {
  const auto regions = make_regions(surface_, stretch_, {}, {}).value();
  const auto blend = BlendWeights::create(surface_, regions, 5, {}).value();
  const Facets facets(surface_);
  for (std::size_t e = 0; e < facets.edges().size(); ++e) {
    const auto sides = facets.edges().sides(e);
    for (const double fraction : {0.03, 0.37, 0.5, 0.81}) {
      const auto at = [&](int side) {
        return on_side(side, facets.same_direction(sides[0], side) ? fraction : 1 - fraction);
      };
      const auto dip = [&](int side) {
        return regions.fragments.all[regions.fragments.find(side / 3, at(side))].dip;
      };
      // Where the reach changes, the dip of both sides must be the same for the blend to be
      // defined.
      if (regions.fragments.reach[std::size_t(sides[0] / 3)] !=
              regions.fragments.reach[std::size_t(sides[1] / 3)] &&
          dip(sides[0]) != dip(sides[1]))
        continue;
      const auto a = blend.at(sides[0] / 3, at(sides[0]));
      const auto b = blend.at(sides[1] / 3, at(sides[1]));
      for (std::size_t k = 0; k < a.size(); ++k)
        EXPECT_NEAR(a[k], b[k], 1e-6)
            << e << " " << k << " dips " << dip(sides[0]) << " " << dip(sides[1]) << " reach "
            << regions.fragments.reach[std::size_t(sides[0] / 3)] << " "
            << regions.fragments.reach[std::size_t(sides[1] / 3)] << " fr " << fraction << " n "
            << regions.fragments.of_triangle(sides[0] / 3).size() << " "
            << regions.fragments.of_triangle(sides[1] / 3).size();
    }
  }
}

TEST_P(RandomBlend, DoesNotDependOnTheNumberOfThreads) {
  Context one;
  Context eight;
  eight.threads = 8;
  const auto first = make_regions(surface_, stretch_, {}, one).value();
  const auto second = make_regions(surface_, stretch_, {}, eight).value();
  ASSERT_EQ(first.fragments.all.size(), second.fragments.all.size());
  EXPECT_EQ(first.fragments.corners, second.fragments.corners);
  EXPECT_EQ(first.seam_mm, second.seam_mm);
  const auto a = BlendWeights::create(surface_, first, 5, one).value();
  const auto b = BlendWeights::create(surface_, second, 5, eight).value();
  EXPECT_EQ(a.at_points(surface_, one).value(), b.at_points(surface_, eight).value());
  for (const auto& point : testing::random_points(surface_, 500, 2))
    EXPECT_EQ(a.at(point.triangle, point.barycentric), b.at(point.triangle, point.barycentric));
}

TEST_P(RandomBlend, JoiningPiecesAgainChangesNothing) {
  const auto regions = make_regions(surface_, stretch_, {}, {}).value();
  auto fragments = regions.fragments;
  const Facets facets(surface_);
  (void)join_small_pieces(facets, find_borders(facets, fragments), 25, fragments);
  for (std::size_t f = 0; f < fragments.all.size(); ++f) {
    const auto& fragment = regions.fragments.all[f];
    EXPECT_EQ(fragments.all[f].dip, fragment.dip);
    if (fragment.dip != 0) {
      EXPECT_TRUE(fragments.reaches(fragment.dip, fragment.triangle));
    } else {
      EXPECT_EQ(fragments.reach[std::size_t(fragment.triangle)], 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomBlend, ::testing::Range(0, 24));

}  // namespace
}  // namespace hydroprint::plan
