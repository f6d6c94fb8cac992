#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/flow/tiles.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/flow/particles.h"
#include "tests/sim/support/bodies.h"
#include "tests/sim/support/dips.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Follows film points forward until they land. Tracing back from the landing points must find the
/// same film points.
void expect_round_trips(const mesh::Model& model, const hydroprint::testing::DipSetting& setting,
                        int count) {
  // The reference interpolates velocities linearly between waterlines, so the waterlines have to be
  // close together.
  hydroprint::testing::DipSetting close = setting;
  close.schedule.swept_mm = 1;
  const auto dip = hydroprint::testing::solve_dip(model, close);
  const reference::Particles particles(dip.body, dip.field, 0.05);
  const waterline::Motion straight;
  const Landings landings(dip.body, straight);
  std::mt19937 random(17);
  const Vector2d size = setting.film.size_mm();
  std::uniform_real_distribution<double> share(-0.5, 0.5);
  int landed = 0;
  double square = 0, most = 0;
  for (int i = 0; i < count; ++i) {
    const Vector2d film(share(random) * size.x(), share(random) * size.y());
    const auto contact = particles.follow(film);
    if (!contact) continue;
    const Landing landing = landings.on(contact->triangle, contact->barycentric);
    if (!landing.film_can_follow) continue;  // film on this face is excluded by rule
    const auto back = trace_back(dip.field, landing);
    ASSERT_TRUE(back) << "film at " << film.transpose() << " lands, but none is found there";
    const double error = (*back - film).norm();
    square += error * error;
    most = std::max(most, error);
    ++landed;
  }
  EXPECT_GT(landed, count / 5);
  EXPECT_LT(std::sqrt(square / landed), 0.02);
  EXPECT_LT(most, 0.1);
}

TEST(BruteForce, ParticlesAgreeOnASphereOffTheCentre) {
  hydroprint::testing::DipSetting setting;
  setting.film = hydroprint::testing::film_of("120x150");
  setting.depth_mm = 45;
  expect_round_trips(hydroprint::testing::moved(sample::icosphere(30, 5), {14, -22, 0}), setting,
                     500);
}

TEST(BruteForce, ParticlesAgreeOnTwoFeet) {
  hydroprint::testing::DipSetting setting;
  setting.film = hydroprint::testing::film_of("130x90");
  setting.depth_mm = 30;
  expect_round_trips(hydroprint::testing::together(
                         {hydroprint::testing::moved(sample::icosphere(18, 4), {-24, 3, 0}),
                          hydroprint::testing::moved(sample::icosphere(22, 4), {22, -5, 6})}),
                     setting, 500);
}

TEST(BruteForce, ParticlesAgreeInARing) {
  hydroprint::testing::DipSetting setting;
  setting.film = hydroprint::testing::film_of("120x120");
  expect_round_trips(
      hydroprint::testing::moved(hydroprint::testing::torus(26, 9, 96, 48), {6, 4, 0}), setting,
      400);
}

}  // namespace
}  // namespace hydroprint::flow
