// Exact solutions of the field notes, section 2, and three more of the same kind.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "sim/flow/flow_map.h"
#include "sim/flow/trace.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/support/bodies.h"
#include "tests/sim/support/dips.h"
#include "tests/support/exact_sphere.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::DipSetting;
using testing::SolvedDip;
constexpr double kDegree = std::numbers::pi / 180;

double depth_at(double radius_mm, double degrees) {
  return radius_mm * (1 - std::cos(degrees * kDegree));
}

Vector2d direction(double azimuth_rad) { return {std::cos(azimuth_rad), std::sin(azimuth_rad)}; }

/// The landing at a point of a centred sphere, when the water reaches it.
Landing on_sphere(double radius_mm, double theta_rad, double azimuth_rad) {
  const Vector2d outward = direction(azimuth_rad);
  return {radius_mm * std::sin(theta_rad) * outward, radius_mm * (1 - std::cos(theta_rad)),
          -std::tan(theta_rad / 2) * outward, true, true};
}

struct Errors {
  double square = 0, most = 0;
  int count = 0;
  void add(double error) {
    square += error * error;
    most = std::max(most, std::abs(error));
    ++count;
  }
  [[nodiscard]] double rms() const { return std::sqrt(square / std::max(count, 1)); }
};

TEST(ExactSphere, FormulaGivesTheEightDigitsOfTheTable) {
  const std::map<double, double> table = {{10, 6.97242041},  {30, 20.69636813},  {60, 39.74423988},
                                          {90, 55.09681288}, {110, 62.49930249}, {120, 65.32423024},
                                          {135, 68.5571922}, {150, 70.72089069}};
  for (const auto& [degrees, radius_mm] : table) {
    EXPECT_NEAR(exact::film_radius_mm(40, 105, degrees * kDegree), radius_mm, 2e-8);
    EXPECT_NEAR(exact::contact_angle_rad(40, 105, radius_mm), degrees * kDegree, 1e-7);
  }
}

TEST(ExactSphere, FilmIsTracedBackToItsRadius) {
  DipSetting setting;
  setting.film = testing::round_film(105);
  setting.depth_mm = depth_at(40, 151);
  const SolvedDip dip = testing::solve_dip(sample::icosphere(40, 6), setting);
  Errors errors;
  for (const double degrees : {10, 30, 60, 90, 110, 120, 135, 150}) {
    for (int i = 0; i < 12; ++i) {
      const double azimuth = 0.1 + i * std::numbers::pi / 6;
      const auto film = trace_back(dip.field, on_sphere(40, degrees * kDegree, azimuth));
      ASSERT_TRUE(film) << degrees;
      const double landed = exact::contact_angle_rad(40, 105, film->norm());
      const double along_mm = 40 * (landed - degrees * kDegree);
      EXPECT_LT(std::abs(along_mm), degrees > 121 ? 0.08 : 0.03) << degrees << " degrees";
      if (degrees < 121) errors.add(along_mm);
      EXPECT_NEAR(film->normalized().dot(direction(azimuth)), 1, 1e-7);
    }
  }
  EXPECT_LT(errors.rms(), 0.01);

  // The map at the vertices of the mesh, and its stretch (section 6), for the same dip.
  MapOptions options;
  options.make_tiles = false;
  options.dip_speed_mm_per_s = 4;
  const FlowMap map = make_flow_map(dip.surface, dip.body, dip.field, {}, options, {}).value();
  Errors at_vertices;
  const double vat2 = 105.0 * 105.0 / (40.0 * 40.0);
  for (std::size_t v = 0; v < dip.surface.points.size(); ++v) {
    const Vector3d& p = dip.surface.points[v];
    const double theta = std::acos(std::clamp(-p.z() / p.norm(), -1.0, 1.0));
    if (theta > 120 * kDegree) continue;
    const Vector2d& film = map.surface.film_mm[v];
    ASSERT_TRUE(film.allFinite());
    at_vertices.add(40 * (exact::contact_angle_rad(40, 105, film.norm()) - theta));
    EXPECT_NEAR(map.surface.contact_time_s[v], dip.body.points_mm[v].z() / 4, 1e-9);
    if (theta < 20 * kDegree || p.norm() < 40 - 1e-6) continue;
    const double r0 = exact::film_radius_mm(40, 105, theta);
    const double around = 40 * std::sin(theta) / r0;
    const double area =
        (vat2 - 1 + std::pow(std::cos(theta), 2)) / (vat2 * (1 - std::pow(r0 / 105, 2)));
    const double along = area / around;
    EXPECT_NEAR(map.surface.stretch[v], std::max(along, around), 0.02 * along);
    EXPECT_NEAR(map.surface.least_stretch[v], std::min(along, around), 0.02 * around);
    EXPECT_NEAR(map.surface.stretch[v] * map.surface.least_stretch[v] / area, 1, 0.02);
  }
  EXPECT_GT(at_vertices.count, 5000);
  EXPECT_LT(at_vertices.rms(), 0.01);
  EXPECT_LT(at_vertices.most, 0.05);
}

TEST(ExactSphere, InAWideVatIsNearlyEqualArea) {
  const double radius = 15, vat = 180;
  DipSetting setting;
  setting.film = testing::round_film(vat);
  setting.depth_mm = depth_at(radius, 122);
  const SolvedDip dip = testing::solve_dip(sample::icosphere(radius, 5), setting);
  for (const double degrees : {15, 45, 75, 90, 105, 120}) {
    const double theta = degrees * kDegree;
    for (const double azimuth : {0.3, 2.0, 4.4}) {
      const auto film = trace_back(dip.field, on_sphere(radius, theta, azimuth));
      ASSERT_TRUE(film);
      EXPECT_NEAR(film->norm(), exact::film_radius_mm(radius, vat, theta), 0.02) << degrees;
      EXPECT_NEAR(film->norm() / (2 * radius * std::sin(theta / 2)), 1, 0.01) << degrees;
    }
  }
}

TEST(ExactCone, InACircularVat) {
  const double vat = 60;
  for (const double slope_degrees : {25, 60}) {
    const double slope = slope_degrees * kDegree;
    DipSetting setting;
    setting.film = testing::round_film(vat);
    setting.depth_mm = 41 * std::tan(slope);
    const SolvedDip dip =
        testing::solve_dip(testing::cone(slope, 42 * std::tan(slope), 240), setting);
    for (const double a : {0.5, 3.0, 15.0, 28.0, 40.0}) {
      const Vector2d outward = direction(0.4);
      const auto film = trace_back(dip.field, {a * outward, a * std::tan(slope),
                                               -std::tan(slope / 2) * outward, true, true});
      ASSERT_TRUE(film) << a;
      const double exact_mm =
          vat * std::sqrt(1 - std::pow(1 - a * a / (vat * vat), 1 / std::cos(slope)));
      // The tip is wetted in the first steps, which are long compared with the size of its
      // waterline.
      EXPECT_NEAR(film->norm(), exact_mm, a < 1 ? 0.1 : 0.03)
          << "cone of " << slope_degrees << " at " << a;
    }
  }
}

TEST(ExactWedge, InAStrip) {
  // The ridge is far longer than the strip is wide, so its ends do not matter in the middle.
  const double half_width = 25, slope = 50 * kDegree;
  DipSetting setting;
  setting.film = testing::film_of("50x170");
  setting.depth_mm = 20 * std::tan(slope);
  const SolvedDip dip =
      testing::solve_dip(testing::wedge(slope, 21 * std::tan(slope), 65), setting);
  for (const double a : {1.0, 5.0, 12.0, 19.0}) {
    for (const double side : {-1.0, 1.0}) {
      for (const double y : {-10.0, 3.0}) {
        const auto film =
            trace_back(dip.field, {Vector2d(side * a, y), a * std::tan(slope),
                                   Vector2d(-side * std::tan(slope / 2), 0), true, true});
        ASSERT_TRUE(film) << a;
        const double exact_mm =
            half_width * (1 - std::pow(1 - a / half_width, 1 / std::cos(slope)));
        EXPECT_NEAR(film->x(), side * exact_mm, 0.02) << a;
        EXPECT_NEAR(film->y(), y, 0.02) << a;
      }
    }
  }
}

// A vertical wall pulls with tan 45 degrees = 1. With u = A r + B / r and s = 1 - r^2 / Rv^2, film
// outside a cylinder of radius a satisfies ds/dz = 2 a s / (Rv^2 - a^2).
TEST(ExactCylinder, FilmIsDrawnUpItsWall) {
  const double a = 15, vat = 50;
  DipSetting setting;
  setting.film = testing::round_film(vat);
  const SolvedDip dip = testing::solve_dip(testing::cylinder(a, 30, 240), setting);
  for (const double z : {0.5, 5.0, 15.0, 29.0}) {
    const Vector2d outward = direction(1.9);
    const auto film = trace_back(dip.field, {a * outward, z, -outward, true, true});
    ASSERT_TRUE(film) << z;
    const double s = (1 - a * a / (vat * vat)) * std::exp(-2 * a * z / (vat * vat - a * a));
    EXPECT_NEAR(film->norm(), vat * std::sqrt(1 - s), 0.02) << z;
  }
  for (const double r : {0.0, 7.0, 14.9}) {  // the whole bottom meets the film at once
    const auto film = trace_back(dip.field, {r * direction(0.2), 0, Vector2d(0, 0), true, true});
    ASSERT_TRUE(film);
    EXPECT_LT((*film - r * direction(0.2)).norm(), 1e-9);
  }
}

// Inside the cup, u = r / a. Film that lands at height z was at radius a exp(-z / a) at rest. The
// air escapes through a small vent.
TEST(ExactCup, TrappedFilmIsSpreadOverWallAndCeiling) {
  const double a = 15;
  DipSetting setting;
  setting.film = testing::round_film(40);
  const SolvedDip dip = testing::solve_dip(testing::cup(a, 18, 25, 5, false, 240, 0.5), setting);
  for (const double z : {0.5, 4.0, 12.0, 19.0}) {
    const Vector2d outward = direction(2.6);
    const auto film = trace_back(dip.field, {a * outward, z, outward, true, true});
    ASSERT_TRUE(film) << z;
    EXPECT_NEAR(film->norm(), a * std::exp(-z / a), 0.02) << z;
  }
  for (const double r : {1.0, 8.0, 14.0}) {
    const auto film = trace_back(dip.field, {r * direction(1), 20, Vector2d(0, 0), true, true});
    ASSERT_TRUE(film);
    EXPECT_NEAR(film->norm(), r * std::exp(-20 / a), 0.02) << r;
  }
}

double rms_of_sphere(double factor, int subdivisions) {
  DipSetting setting;
  setting.film = testing::round_film(105);
  setting.depth_mm = depth_at(40, 112);
  setting.max_edge_mm = 100;
  setting.coarsen(factor);
  const SolvedDip dip = testing::solve_dip(sample::icosphere(40, subdivisions), setting);
  Errors errors;
  for (double degrees = 6; degrees < 111; degrees += 3.7) {
    for (int i = 0; i < 9; ++i) {
      const auto film =
          trace_back(dip.field, on_sphere(40, degrees * kDegree, 0.2 + i * std::numbers::pi / 4.5));
      if (!film) return 1e9;
      errors.add(film->norm() - exact::film_radius_mm(40, 105, degrees * kDegree));
    }
  }
  return errors.rms();
}

TEST(Refinement, HalvingStepsMeshAndFacesQuartersTheError) {
  const double coarse = rms_of_sphere(4, 4), middle = rms_of_sphere(2, 5),
               fine = rms_of_sphere(1, 6);
  EXPECT_GT(std::log2(coarse / middle), 1.6) << coarse << ' ' << middle << ' ' << fine;
  EXPECT_GT(std::log2(middle / fine), 1.6) << coarse << ' ' << middle << ' ' << fine;
  EXPECT_LT(fine, 0.006);
}

}  // namespace
}  // namespace hydroprint::flow
