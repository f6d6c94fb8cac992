// Compares the fast map with the paper's method pixel by pixel, with one particle per pixel.
#include "tests/sim/flow/pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

#include "sim/flow/flow_map.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/support/bodies.h"
#include "tests/sim/support/dips.h"
#include "tests/support/two_threads.h"

namespace hydroprint::flow::reference {
namespace {

using hydroprint::testing::DipSetting;
using hydroprint::testing::SolvedDip;
using hydroprint::testing::two_threads;

/// Allowed error of the map in pixels: 0.04 mm at 600 dpi.
constexpr double kTolerance_px = 0.945;

/// The tiles of a dip at the default settings for a resolution, and particles in a dip with smaller
/// steps. Particles need the smaller steps because they interpolate velocities linearly between
/// waterlines.
class Trial {
 public:
  Trial(const mesh::Model& model, DipSetting setting, double dpi = 600)
      : pixel_mm_(25.4 / dpi),
        dip_(hydroprint::testing::solve_dip(model, setting)),
        fast_(make_flow_map(dip_.surface, dip_.body, dip_.field, {}, for_resolution({}, dpi),
                            two_threads())
                  .value()),
        map_(dip_.body, fast_.tiles, image::film_grid(setting.film, pixel_mm_)),
        close_(closely(model, std::move(setting))),
        particles_(dip_.body, close_.field, 0.1),
        comparison_(map_, dip_.body, particles_) {}

  /// Share of random pixels within the tolerance, among those at which the map or a particle lands.
  [[nodiscard]] double share_within(int count) const {
    std::mt19937 random(23);
    int landed = 0, within = 0;
    for (int i = 0; i < count; ++i) {
      const PixelError error = comparison_.at(any_pixel(random));
      if (!error.lands || error.is_ruled) continue;
      ++landed;
      within += error.error_mm <= kTolerance_px * pixel_mm_;
    }
    EXPECT_GT(landed, count / 5);
    return static_cast<double>(within) / landed;
  }

  /// Largest error, on the film, in the position of a jump, over `count` random pixels at jumps.
  [[nodiscard]] double largest_jump_distance_mm(int count) const {
    std::mt19937 random(29);
    double most = 0;
    while (count > 0) {
      const Pixel pixel = any_pixel(random);
      if (!map_.is_at_jump(pixel)) continue;
      most = std::max(most, comparison_.jump_distance_mm(pixel));
      --count;
    }
    return most;
  }

 private:
  static SolvedDip closely(const mesh::Model& model, DipSetting setting) {
    setting.schedule.swept_mm /= 4;
    return hydroprint::testing::solve_dip(model, setting);
  }

  Pixel any_pixel(std::mt19937& random) const {
    return {static_cast<int>(random() % static_cast<unsigned>(map_.grid().columns)),
            static_cast<int>(random() % static_cast<unsigned>(map_.grid().rows))};
  }

  double pixel_mm_;
  SolvedDip dip_;
  FlowMap fast_;
  PixelMap map_;
  SolvedDip close_;
  Particles particles_;
  PixelComparison comparison_;
};

TEST(Pixels, OfASphereAreWhereParticlesLand) {
  DipSetting setting;
  setting.film = hydroprint::testing::film_of("120x150");
  setting.depth_mm = 45;
  const Trial trial(hydroprint::testing::moved(sample::icosphere(30, 5), {14, -22, 0}), setting);
  EXPECT_GE(trial.share_within(4000), 0.999);
  EXPECT_LE(trial.largest_jump_distance_mm(100), 25.4 / 600);
}

TEST(Pixels, OfASphereAt150DpiAreWhereParticlesLand) {
  DipSetting setting;
  setting.film = hydroprint::testing::film_of("120x150");
  setting.depth_mm = 45;
  const Trial trial(hydroprint::testing::moved(sample::icosphere(30, 5), {14, -22, 0}), setting,
                    150);
  EXPECT_GE(trial.share_within(2000), 0.999);
  EXPECT_LE(trial.largest_jump_distance_mm(50), 25.4 / 150);
}

TEST(Pixels, OfTwoFeetAreWhereParticlesLand) {
  DipSetting setting;
  setting.film = hydroprint::testing::film_of("130x90");
  setting.depth_mm = 30;
  const Trial trial(hydroprint::testing::together(
                        {hydroprint::testing::moved(sample::icosphere(18, 5), {-24, 3, 0}),
                         hydroprint::testing::moved(sample::icosphere(22, 5), {22, -5, 6})}),
                    setting);
  EXPECT_GE(trial.share_within(4000), 0.999);
  EXPECT_LE(trial.largest_jump_distance_mm(100), 25.4 / 600);
}

}  // namespace
}  // namespace hydroprint::flow::reference
