// Long thin films, tiny bodies, and bodies at the film's edge, each with both film models.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "sim/sample/icosphere.h"
#include "tests/sim/pipeline/dips.h"
#include "tests/sim/support/bodies.h"
#include "tests/support/exact_sphere.h"

namespace hydroprint::pipeline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::dipped;
using testing::for_each_point;
using testing::options_for;
using testing::warns;
namespace bodies = hydroprint::testing;
constexpr double kDegree = std::numbers::pi / 180;

class Extremes : public ::testing::TestWithParam<FilmModel> {};

INSTANTIATE_TEST_SUITE_P(Models, Extremes, ::testing::Values(FilmModel::kStokes, FilmModel::kSheet),
                         [](const auto& model) {
                           return model.param == FilmModel::kStokes ? "Stokes" : "Sheet";
                         });

double depth_at(double radius_mm, double degrees) {
  return radius_mm * (1 - std::cos(degrees * kDegree));
}

Pose at(double x_mm, double y_mm) { return Pose(Eigen::Translation3d(x_mm, y_mm, 0)); }

/// Errors of the landing points on a centred sphere, compared with the exact solution.
struct Errors {
  double rms_mm = 0, max_mm = 0;
  int count = 0;
};

Errors errors_of(const Dip& dip, double radius_mm, double vat_mm, double degrees) {
  Errors out;
  for_each_point(dip, [&](const Vector3d& p, const Vector2d& film) {
    const double theta = std::acos(std::clamp(1 - p.z() / radius_mm, -1.0, 1.0));
    if (theta > degrees * kDegree || !film.allFinite()) return;
    const double landed = exact::contact_angle_rad(radius_mm, vat_mm, film.norm());
    const Vector2d outward = p.head<2>().stableNormalized();
    const double along = radius_mm * (landed - theta);
    const double across = outward.x() * film.y() - outward.y() * film.x();
    const double error =
        std::hypot(along, film.norm() > 0 ? across / film.norm() * radius_mm * std::sin(theta) : 0);
    out.rms_mm += error * error;
    out.max_mm = std::max(out.max_mm, error);
    ++out.count;
  });
  out.rms_mm = std::sqrt(out.rms_mm / std::max(out.count, 1));
  return out;
}

TEST_P(Extremes, TinySpheresAreAsAccurateInMillimetresAsLargeOnes) {
  for (const auto& [radius_mm, vat_mm] :
       {std::pair{5.0, 105.0}, {1.0, 105.0}, {1.0, 6.0}, {0.25, 6.0}}) {
    DipOptions options = options_for("circle:" + std::to_string(vat_mm), GetParam());
    options.depth_mm = depth_at(radius_mm, 121);
    const Dip d = dipped(sample::icosphere(radius_mm, 5), options);
    const Errors errors = errors_of(d, radius_mm, vat_mm, 120);
    EXPECT_GT(errors.count, 7000) << radius_mm;
    EXPECT_LT(errors.rms_mm, 0.01) << radius_mm << " in " << vat_mm;
    EXPECT_LT(errors.max_mm, 0.05) << radius_mm << " in " << vat_mm;
  }
}

TEST_P(Extremes, TheMapIsTheSameEverywhereAlongALongThinFilm) {
  // The sphere's distance from either end is at least twelve times the film's width.
  const mesh::Model sphere = sample::icosphere(4, 5);
  DipOptions options = options_for("600x12", GetParam());
  options.depth_mm = depth_at(4, 121);
  options.X_FO = at(0, 0);
  const Dip middle = dipped(sphere, options);
  options.X_FO = at(150.3, 0);
  const Dip aside = dipped(sphere, options);
  int reached = 0;
  for (std::size_t v = 0; v < middle.surface.points.size(); ++v) {
    const Vector2d here = middle.map.surface.film_mm[v];
    if (!here.allFinite()) continue;
    const double z = (middle.X_FO * middle.surface.points[v]).z();
    if (z > depth_at(4, 120)) continue;
    const Vector2d there = aside.map.surface.film_mm[v] - Vector2d(150.3, 0);
    EXPECT_LT((here - there).norm(), 0.02) << middle.surface.points[v].transpose();
    // No film can come from beyond the long edges.
    EXPECT_LT(std::abs(here.y()), 6);
    ++reached;
  }
  EXPECT_GT(reached, 7000);
}

TEST_P(Extremes, ASphereNearTheEdgeIsDippedUntilItsWaterlineReachesTheEdge) {
  constexpr double kRadius_mm = 10;
  for (const double gap_mm : {8.0, 4.0, 1.0}) {  // distance of its lowest point from the edge
    DipOptions options = options_for("60x80", GetParam());
    options.X_FO = at(30 - gap_mm, 5);
    const Dip d = dipped(sample::icosphere(kRadius_mm, 5), options);
    EXPECT_TRUE(d.figures.stopped_at_edge);
    EXPECT_TRUE(warns(d, WarningCode::FILM_EDGE_REACHED));
    const double height_mm = kRadius_mm - d.figures.depth_mm;
    EXPECT_NEAR(std::sqrt(kRadius_mm * kRadius_mm - height_mm * height_mm), gap_mm, 0.06);
    for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
      if (p.z() > d.figures.depth_mm) {
        EXPECT_FALSE(film.allFinite()) << p.transpose();
      }
      if (p.z() < d.figures.depth_mm - 0.1) {
        EXPECT_TRUE(film.allFinite()) << p.transpose();
      }
    });
  }
}

TEST_P(Extremes, ABoxNearTheEdgeTakesTheFilmBetween) {
  // The distances of its upright side from the film's edge at x = 30 are 0.4, 0.05 and 0 mm.
  for (const double gap_mm : {0.4, 0.05, 0.0}) {
    const mesh::Model box = bodies::box({10, -10, 0}, {30 - gap_mm, 10, 8});
    DipOptions options = options_for("60x80", GetParam());
    options.X_FO = at(0, 0);
    const Dip d = dipped(box, options);
    int bottom = 0;
    for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
      if (p.z() > 0) return;
      ++bottom;
      if (gap_mm > 0) {
        EXPECT_LT((film - p.head<2>()).norm(), 1e-6) << p.transpose();
      }
    });
    EXPECT_GT(bottom, 50);
    EXPECT_EQ(d.figures.stopped_at_edge, gap_mm == 0);
  }
}

TEST_P(Extremes, ANeedleDoesNotMoveFilmFarAway) {
  // 0.4 mm wide and 30 mm long: the needle is thinner than every length of the mesh.
  const mesh::Model needle = bodies::turned({{0, 0}, {0.2, 1}, {0.2, 30}, {0, 30}}, 16);
  DipOptions options = options_for("A4", GetParam());
  const Dip d = dipped(needle, options);
  EXPECT_GT(d.figures.coverage, 0.9);
  for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
    // The surroundings only supply film for the needle's small wall.
    if (film.allFinite()) {
      EXPECT_LT(film.norm(), 0.2 + p.z()) << p.transpose();
    }
  });
}

}  // namespace
}  // namespace hydroprint::pipeline
