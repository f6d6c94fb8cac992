#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "sim/film/outline.h"
#include "sim/fit/points.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/dip.h"
#include "sim/pipeline/pipeline.h"
#include "sim/sample/icosphere.h"
#include "sim/validate/film_locator.h"
#include "tests/support/two_threads.h"

namespace hydroprint::testing {

/// A body, and its dip through a film with ink.
struct Scene {
  mesh::Model model;
  pipeline::DipOptions dip;
};

/// Ink amount t at a printed point: two strong patches, right and above, and no ink elsewhere.
inline double patches(const Eigen::Vector2d& p) {
  const bool is_right = p.x() > 8 && p.x() < 32 && std::abs(p.y()) < 25;
  const bool is_above = p.y() > 10 && p.y() < 40 && p.x() < -5 && p.x() > -35;
  return is_right ? 2 : is_above ? 3 : 0;
}

/// A ball slightly off the middle of a round film, dipped to 110 degrees, at a coarse resolution.
inline Scene ball(double coarseness = 2.5) {
  Scene scene{sample::icosphere(30, 4), {}};
  scene.dip.outline = film::parse_outline("circle:80").value();
  scene.dip.X_FO = Pose(Eigen::Translation3d(6, -4, 0));
  scene.dip.depth_mm = 30 * (1 - std::cos(110 * std::numbers::pi / 180));
  scene.dip.ink = ink::InkField::from_function(ink::ink_grid(scene.dip.outline), patches).value();
  scene.dip = pipeline::scaled_resolution(scene.dip, coarseness);
  return scene;
}

/// Landing points of a printed grid, rotated by 10 degrees, in a dip with this profile. `fineness`
/// multiplies the mesh lengths and steps of the scene, and the points have noise of `noise_mm` in
/// each direction.
inline std::vector<fit::Point> measured(const Scene& scene, const film::Profile& profile,
                                        double fineness, double noise_mm, unsigned seed,
                                        double pitch_mm = 5) {
  pipeline::DipOptions options = pipeline::scaled_resolution(scene.dip, fineness);
  options.profile = profile;
  options.map.tolerance_mm = 0.01;
  const auto dip = pipeline::dip(scene.model, options, two_threads()).value();
  const validate::FilmLocator locator(dip.surface, dip.map.tiles);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, noise_mm);
  const Eigen::Rotation2Dd turn(10 * std::numbers::pi / 180);
  std::vector<fit::Point> points;
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j) {
      const Eigen::Vector2d film_mm = turn * Eigen::Vector2d(i * pitch_mm, j * pitch_mm);
      auto surface_mm = locator.at(film_mm);
      if (!surface_mm) continue;
      for (int k = 0; k < 3; ++k) (*surface_mm)[k] += noise_mm > 0 ? normal(random) : 0;
      points.push_back({film_mm, *surface_mm});
    }
  }
  return points;
}

}  // namespace hydroprint::testing
