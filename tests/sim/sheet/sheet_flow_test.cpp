// The sheet in whole dips, compared with exact and one-dimensional solutions.
#include "sim/sheet/sheet_flow.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/flow/flow_map.h"
#include "sim/flow/map_error.h"
#include "sim/pipeline/dip.h"
#include "sim/pipeline/pipeline.h"
#include "sim/sample/icosphere.h"
#include "sim/sheet/dip_parts.h"
#include "tests/sim/support/bodies.h"
#include "tests/sim/support/dips.h"
#include "tests/support/axisymmetric_sheet.h"
#include "tests/support/exact_sphere.h"

namespace hydroprint::sheet {
namespace {

using Eigen::Vector2d;
using testing::DipSetting;
using testing::SolvedDip;
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kBase_mm = 0.5;

double depth_at(double radius_mm, double degrees) {
  return radius_mm * (1 - std::cos(degrees * kDegree));
}

double smoothstep(double x) {
  const double t = std::clamp(x + 0.5, 0.0, 1.0);
  return t * t * t * (t * (6 * t - 15) + 10);
}

/// Thickness of a film with a ring of ink from 25 to 40 mm that doubles the thickness.
double ringed_mm(double r) {
  return kBase_mm + kBase_mm * (smoothstep((r - 25) / 3) - smoothstep((r - 40) / 3));
}

/// Mean thickness of a triangle, from the middles of its 64 congruent parts.
RestThickness mean_of(const std::function<double(double)>& thickness_mm) {
  return [thickness_mm](const std::array<Vector2d, 3>& p) {
    const int n = 8;
    double sum = 0;
    int count = 0;
    const auto add = [&](double a, double b) {
      sum += thickness_mm((p[0] + a / n * (p[1] - p[0]) + b / n * (p[2] - p[0])).norm());
      ++count;
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n - i; ++j) {
        add(i + 1.0 / 3, j + 1.0 / 3);
        if (i + j < n - 1) add(i + 2.0 / 3, j + 2.0 / 3);
      }
    }
    return sum / count;
  };
}

double uniform(const std::array<Vector2d, 3>& /*rest_mm*/) { return kBase_mm; }

Context two_threads() {
  Context context;
  context.threads = 2;
  return context;
}

flow::DipField sheet_of(const SolvedDip& dip, const RestThickness& rest, double drag_per_mm = 0) {
  SheetOptions options;
  options.drag_per_mm = drag_per_mm;
  return sheet_flow(dip.field, rest, options, two_threads()).value().field;
}

SolvedDip sphere_in_a_vat(double radius_mm, double vat_mm, double degrees) {
  DipSetting setting;
  setting.film = testing::film_of("circle:" + std::to_string(vat_mm));
  setting.depth_mm = depth_at(radius_mm, degrees);
  return testing::solve_dip(sample::icosphere(radius_mm, 6), setting);
}

flow::Landing on_sphere(double radius_mm, double theta, double azimuth) {
  const Vector2d outward(std::cos(azimuth), std::sin(azimuth));
  return {radius_mm * std::sin(theta) * outward, radius_mm * (1 - std::cos(theta)),
          -std::tan(theta / 2) * outward, true, true};
}

/// Root mean square of the distances on the film between a dip and the one-dimensional solution.
double rms_from(const axisymmetric::Film& film, const flow::DipField& field, double radius_mm) {
  const axisymmetric::Dip exact(film, axisymmetric::sphere(radius_mm, 121 * kDegree), 2000);
  double square = 0;
  int count = 0;
  for (int degrees = 10; degrees <= 120; degrees += 10) {
    const double wetted = axisymmetric::sphere_wetted_mm2(radius_mm, degrees * kDegree);
    for (const double azimuth : {0.2, 1.9, 3.3, 5.1}) {
      const auto traced = flow::trace_back(field, on_sphere(radius_mm, degrees * kDegree, azimuth));
      if (!traced) return INFINITY;
      square += std::pow(traced->norm() - exact.at_wetted(wetted)->film_mm, 2);
      ++count;
    }
  }
  return std::sqrt(square / count);
}

TEST(SheetFlow, OfUniformFilmRoundACentredSphereIsTheExactMap) {
  const SolvedDip dip = sphere_in_a_vat(40, 105, 121);
  const flow::DipField field = sheet_of(dip, uniform);
  for (const double degrees : {10, 30, 60, 90, 110, 120}) {
    for (const double azimuth : {0.4, 2.2, 4.9}) {
      const auto film = flow::trace_back(field, on_sphere(40, degrees * kDegree, azimuth));
      ASSERT_TRUE(film);
      const double landed = exact::contact_angle_rad(40, 105, film->norm());
      EXPECT_NEAR(40 * landed, 40 * degrees * kDegree, 0.05) << degrees;
    }
  }
}

TEST(SheetFlow, WithARingOfInkIsTheOneDimensionalSolution) {
  const SolvedDip dip = sphere_in_a_vat(40, 105, 121);
  const flow::DipField field = sheet_of(dip, mean_of(ringed_mm));
  EXPECT_LT(rms_from({105, ringed_mm, kBase_mm, 0}, field, 40), 0.02);
  // The ring matters: the result without the ring differs.
  const flow::DipField plain = sheet_of(dip, uniform);
  EXPECT_GT(rms_from({105, ringed_mm, kBase_mm, 0}, plain, 40), 0.1);
}

TEST(SheetFlow, WithWaterDragIsTheOneDimensionalSolution) {
  const SolvedDip dip = sphere_in_a_vat(30, 80, 121);
  const double drag_length_mm = 25;
  const double drag_per_mm = kBase_mm / (drag_length_mm * drag_length_mm);
  const axisymmetric::Film film{80, [](double) { return kBase_mm; }, kBase_mm, drag_length_mm};
  EXPECT_LT(rms_from(film, sheet_of(dip, uniform, drag_per_mm), 30), 0.02);
  EXPECT_GT(rms_from(film, sheet_of(dip, uniform), 30), 0.3);
}

TEST(SheetFlow, IsWithinItsToleranceOfTheSettledOne) {
  const SolvedDip dip = sphere_in_a_vat(30, 70, 100);
  const RestThickness rest = mean_of(ringed_mm);
  const auto solved = [&](double tolerance_mm) {
    SheetOptions options;
    options.tolerance_mm = tolerance_mm;
    options.most_sweeps = 20;
    return sheet_flow(dip.field, rest, options, two_threads()).value();
  };
  constexpr double kTolerance_mm = 1e-4;
  const SheetFlow quick = solved(kTolerance_mm), settled = solved(0);
  ASSERT_GE(quick.sweeps, 3)
      << "at least three sweeps are needed for some waterlines to settle before others";
  EXPECT_EQ(quick.unsettled_mm, 0);
  double apart_mm = 0;
  for (std::size_t k = 0; k < dip.field.fields.size(); ++k) {
    apart_mm += span_mm(dip.field, k) *
                rms_change(quick.field.fields[k].nodes(), settled.field.fields[k].nodes());
  }
  const auto windows = static_cast<double>((dip.field.fields.size() + 7) / 8);
  EXPECT_LT(apart_mm, windows * kTolerance_mm);
  EXPECT_GT(settled.sweeps, quick.sweeps);
}

TEST(SheetFlow, OnlyRelativeThicknessMatters) {
  DipSetting setting;
  setting.film = testing::film_of("120x90");
  setting.depth_mm = 25;
  const SolvedDip dip =
      testing::solve_dip(testing::moved(sample::icosphere(20, 4), {9, -6, 0}), setting);
  const auto inked = [](double scale) {
    return [scale](const std::array<Vector2d, 3>& p) {
      return scale * (1 + 0.5 * std::tanh(p[0].x() / 10));
    };
  };
  const flow::DipField thin = sheet_of(dip, inked(0.03)), thick = sheet_of(dip, inked(0.9));
  for (std::size_t k = 0; k < thin.fields.size(); ++k) {
    for (std::size_t n = 0; n < thin.fields[k].nodes().size(); ++n) {
      EXPECT_LT((thin.fields[k].nodes()[n] - thick.fields[k].nodes()[n]).norm(), 1e-6);
    }
  }
}

TEST(SheetFlow, KeepsTheVolumeOfTheFilm) {
  DipSetting setting;
  setting.film = testing::film_of("120x100");
  setting.depth_mm = depth_at(25, 115);
  const SolvedDip dip =
      testing::solve_dip(testing::moved(sample::icosphere(25, 6), {8, -5, 0}), setting);
  const auto thickness = [](double r) { return 0.1 + 0.05 * std::sin(r / 9); };
  const RestThickness rest = mean_of(thickness);
  const flow::DipField field = sheet_of(dip, rest);

  const std::size_t last = field.fields.size() - 1;
  const velocity::FilmMesh& mesh = field.fields[last].mesh();
  const std::vector<double> h = floating_film(field, last, rest, 3).thickness_mm;
  double floating = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3i& v = mesh.triangles[t];
    const Vector2d ab = mesh.vertices_mm[v[1]] - mesh.vertices_mm[v[0]];
    const Vector2d ac = mesh.vertices_mm[v[2]] - mesh.vertices_mm[v[0]];
    floating += h[t] * 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
  }
  flow::DipField wetted = field;  // the film on the body at the last waterline
  wetted.depth_mm = field.immersion_mm[last];
  flow::MapOptions fine;  // the tiles may end one tile width below the waterline
  fine.least_edge_mm = 0.01;
  const auto map =
      flow::make_flow_map(dip.surface, dip.body, wetted, {}, fine, two_threads()).value();
  double deposit = 0;
  for (const flow::MappedTriangle& tile : map.tiles) {
    const Vector2d ab = tile.film_mm[1] - tile.film_mm[0];
    const Vector2d ac = tile.film_mm[2] - tile.film_mm[0];
    deposit += rest({tile.film_mm[0], tile.film_mm[1], tile.film_mm[2]}) * 0.5 *
               (ab.x() * ac.y() - ab.y() * ac.x());
  }
  double total = 0;
  const double cell = 0.25;
  for (double x = -60 + cell / 2; x < 60; x += cell) {
    for (double y = -50 + cell / 2; y < 50; y += cell) {
      total += thickness(std::hypot(x, y)) * cell * cell;
    }
  }
  EXPECT_NEAR((floating + deposit) / total, 1, 1e-3) << floating << " + " << deposit;
}

TEST(SheetFlow, IsMirroredWithTheBodyAndItsInk) {
  DipSetting setting;
  setting.film = testing::film_of("110x90");
  setting.depth_mm = 22;
  const auto map_of = [&](double side) {
    const SolvedDip dip =
        testing::solve_dip(testing::moved(sample::icosphere(18, 5), {side * 11, 4, 0}), setting);
    const flow::DipField field = sheet_of(dip, [side](const std::array<Vector2d, 3>& p) {
      return 1 + 0.4 * std::tanh(side * (p[0] + p[1] + p[2]).x() / 30);
    });
    std::vector<Vector2d> film;
    for (int i = 0; i < 24; ++i) {
      flow::Landing landing = on_sphere(18, (20 + 3.0 * i) * kDegree, 0.7 * i);
      landing.point_mm.x() *= side;
      landing.pull.x() *= side;
      landing.point_mm += Vector2d(side * 11, 4);
      film.push_back(flow::trace_back(field, landing).value());
      film.back().x() *= side;
    }
    return film;
  };
  const auto right = map_of(1), left = map_of(-1);
  for (std::size_t i = 0; i < right.size(); ++i) EXPECT_LT((right[i] - left[i]).norm(), 0.02);
}

/// Returns for each landing whether its film had torn, in a sheet with this limit.
std::vector<char> torn_before(const flow::DipField& field,
                              const std::vector<flow::Landing>& landings) {
  const std::vector<char> none(landings.size(), 0);
  return flow::trace_back_with_error(field, landings, none, {}, two_threads()).value().has_torn;
}

/// Larger principal stretch of the exact map of a centred sphere at a contact angle.
double exact_stretch(double radius_mm, double vat_mm, double theta) {
  const double step = 1e-4;
  const double film_mm = exact::film_radius_mm(radius_mm, vat_mm, theta);
  const double along_mm = exact::film_radius_mm(radius_mm, vat_mm, theta + step) - film_mm;
  return std::max(radius_mm * std::sin(theta) / film_mm, radius_mm * step / along_mm);
}

TEST(SheetFlow, TearsRoundASphereWhereTheExactStretchExceedsTheLimit) {
  const SolvedDip dip = sphere_in_a_vat(40, 105, 121);
  SheetOptions options;
  options.tear_stretch = exact_stretch(40, 105, 90 * kDegree);
  const auto sheet = sheet_flow(dip.field, uniform, options, two_threads()).value();
  std::vector<flow::Landing> whole, torn;
  for (int degrees = 5; degrees <= 120; degrees += 5) {
    const double stretch = exact_stretch(40, 105, degrees * kDegree);
    for (const double azimuth : {0.4, 2.2, 4.9}) {
      if (stretch < 0.93 * options.tear_stretch)
        whole.push_back(on_sphere(40, degrees * kDegree, azimuth));
      if (stretch > 1.07 * options.tear_stretch)
        torn.push_back(on_sphere(40, degrees * kDegree, azimuth));
    }
  }
  ASSERT_GT(whole.size(), 20);
  ASSERT_GT(torn.size(), 6);
  for (const char is_torn : torn_before(sheet.field, whole)) EXPECT_EQ(is_torn, 0);
  for (const char is_torn : torn_before(sheet.field, torn)) EXPECT_EQ(is_torn, 1);
}

TEST(SheetFlow, FilmThatToreOnceStaysTorn) {
  const SolvedDip dip = sphere_in_a_vat(40, 105, 121);
  flow::DipField field = dip.field;
  for (const velocity::VelocityField& f : field.fields)
    field.is_torn.emplace_back(f.mesh().triangles.size(), 0);
  const std::size_t k = field.fields.size() / 2;
  std::ranges::fill(field.is_torn[k], 1);
  std::vector<flow::Landing> landings;
  for (int degrees = 5; degrees <= 120; degrees += 5)
    landings.push_back(on_sphere(40, degrees * kDegree, 1.1));
  const auto torn = torn_before(field, landings);
  for (std::size_t i = 0; i < landings.size(); ++i)
    EXPECT_EQ(torn[i] != 0, landings[i].immersion_mm > field.immersion_mm[k]) << i;
}

TEST(SheetFlow, IsBitIdenticalForAnyNumberOfThreads) {
  pipeline::DipOptions options;
  options.outline = testing::film_of("90x80");
  options.depth_mm = 20;
  options.X_FO = Pose(Eigen::Translation3d(5, -3, 0));
  const mesh::Model model = sample::icosphere(18, 4);
  Context one;
  const auto a = pipeline::dip(model, options, one).value();
  Context three;
  three.threads = 3;
  const auto b = pipeline::dip(model, options, three).value();
  for (std::size_t v = 0; v < a.map.surface.film_mm.size(); ++v) {
    const Vector2d& p = a.map.surface.film_mm[v];
    if (std::isnan(p.x())) {
      EXPECT_TRUE(std::isnan(b.map.surface.film_mm[v].x()));
    } else {
      EXPECT_EQ(p, b.map.surface.film_mm[v]);
    }
  }
}

TEST(SheetFlow, OfASwollenFilmEqualsThatOfALargerFilm) {
  // Printed with a radius of 60 mm, the film floats with a radius of 72 mm. Its map is the exact
  // map of the larger film, scaled down.
  pipeline::DipOptions options;
  options.outline = testing::film_of("circle:60");
  options.profile.swelling = {1.2, 1.2};
  options.depth_mm = depth_at(25, 118);
  const auto dip = pipeline::dip(sample::icosphere(25, 6), options, two_threads()).value();
  double square = 0;
  int count = 0;
  for (std::size_t v = 0; v < dip.surface.points.size(); ++v) {
    const Eigen::Vector3d& p = dip.surface.points[v];
    const double theta = std::acos(std::clamp(-p.z() / 25, -1.0, 1.0));
    if (theta > 115 * kDegree) continue;
    square +=
        std::pow(dip.map.surface.film_mm[v].norm() - exact::film_radius_mm(25, 72, theta) / 1.2, 2);
    ++count;
  }
  EXPECT_LT(std::sqrt(square / count), 0.02);
}

}  // namespace
}  // namespace hydroprint::sheet
