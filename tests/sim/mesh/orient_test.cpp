#include "sim/mesh/orient.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "sim/mesh/make_surface.h"
#include "sim/mesh/parallel_rays.h"
#include "sim/mesh/rays.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/mesh/files.h"
#include "tests/sim/support/bodies.h"
#include "tests/support/paths.h"

namespace hydroprint::mesh {
namespace {

using testing::inside_out;
using testing::moved;
using testing::together;
using Point = Eigen::Vector3d;

Model scaled(Model model, double factor) {
  for (auto& p : model.vertices) p *= factor;
  return model;
}

Point middle(const Model& model, std::size_t t) {
  const auto& v = model.triangles[t];
  return (model.vertices[v[0]] + model.vertices[v[1]] + model.vertices[v[2]]) / 3;
}

/// The model without the triangles whose middle satisfies a condition.
Model without(Model model, const std::function<bool(const Point&)>& condition) {
  std::vector<Eigen::Vector3i> kept;
  for (std::size_t t = 0; t < model.triangles.size(); ++t)
    if (!condition(middle(model, t))) kept.push_back(model.triangles[t]);
  model.triangles = kept;
  return model;
}

/// A ball with holes of about 5 mm around seven directions.
Model ball_with_holes(double radius = 20) {
  return without(sample::icosphere(radius, 4), [&](const Point& p) {
    for (const Point& hole : {Point(1, 0, 0), Point(-1, 0.1, 0), Point(0, 1, 0.2), Point(0, -1, 0),
                              Point(0.3, 0, 1), Point(0, 0, -1), Point(1, 1, 1)})
      if (p.normalized().dot(hole.normalized()) > 0.97) return true;
    return false;
  });
}

Surface surface_of(const Model& model) { return testing::surface_of(model, 1e9); }

/// Share of the triangles that look in the direction that `outward` gives for their middle.
double outward_share(const Surface& s, const std::function<Point(const Point&)>& outward) {
  double good = 0;
  for (const auto& t : s.triangles) {
    const Point a = s.points[t[0]], b = s.points[t[1]], c = s.points[t[2]];
    good += (b - a).cross(c - a).dot(outward((a + b + c) / 3)) > 0 ? 1 : 0;
  }
  return good / static_cast<double>(s.triangles.size());
}

std::string warning(const Surface& surface, WarningCode code) {
  for (const Warning& w : surface.warnings)
    if (w.code == code) return w.message;
  return {};
}

/// Claims that all triangles look outward, in whichever orientation each part is given.
void expect_outward(const std::vector<Model>& parts,
                    const std::function<Point(const Point&)>& outward) {
  for (unsigned set = 0; set < 1U << parts.size(); ++set) {
    std::vector<Model> given = parts;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if ((set >> i & 1) != 0) given[i] = inside_out(parts[i]);
    EXPECT_EQ(outward_share(surface_of(together(given)), outward), 1) << "turned over: " << set;
  }
}

Point radial(const Point& p) { return p; }

TEST(Orient, ABallWithHolesFacesOutward) {
  expect_outward({ball_with_holes()}, radial);
  const Surface surface = surface_of(inside_out(ball_with_holes()));
  ASSERT_EQ(surface.shells.size(), 1U);
  EXPECT_EQ(surface.shells[0].rule, SideRule::kRays);
  EXPECT_TRUE(surface.shells[0].turned_over);
  EXPECT_FALSE(surface.shells[0].closed);
  EXPECT_NE(warning(surface, WarningCode::SIDES_BY_RAYS), "");
  EXPECT_NE(warning(surface, WarningCode::INSIDE_OUT), "");
}

TEST(Orient, ABottleWithAnOpenRimFacesAwayFromItsGlass) {
  // Glass 2 mm thick, in two pieces with a slit at the rim, and in one piece without a bottom. The
  // neck is narrow, so few rays from the inner wall leave the bottle.
  const std::vector<Eigen::Vector2d> outer = {{0, 0}, {20, 0}, {20, 60}, {6, 70}, {6, 90}};
  const std::vector<Eigen::Vector2d> inner = {{4, 90}, {4, 70}, {18, 58.5}, {18, 2}, {0, 2}};
  const auto away = [](const Point& p) {
    // On each face of the two walls, the direction away from the middle of the glass.
    const double r = std::hypot(p.x(), p.y());
    const Point out(p.x() / r, p.y() / r, 0), up = Point::UnitZ();
    if (p.z() < 0.1) return Point(-up);
    if (p.z() > 89.9) return up;
    if (p.z() < 2.1 && r < 17.9) return up;
    const double wall = p.z() < 59 ? 19 : p.z() > 70 ? 5 : 19 - 14 * (p.z() - 59) / 11;
    return Point(r > wall ? out : -out);
  };
  expect_outward({testing::turned(outer, 48), testing::turned(inner, 48)}, away);
  std::vector<Eigen::Vector2d> both = inner;
  std::ranges::reverse(both);
  both.insert(both.end(), outer.rbegin(), outer.rend());
  both.erase(both.end() - 1);
  expect_outward({testing::turned(both, 48)}, away);
}

TEST(Orient, ABowlWithoutThicknessFacesOutOfItsRoundSide) {
  expect_outward({without(sample::icosphere(20, 4), [](const Point& p) { return p.z() > 0; })},
                 radial);
}

TEST(Orient, OpenShellsSideBySideAreJudgedSeparately) {
  const Model left = ball_with_holes(), right = moved(ball_with_holes(), {41, 0, 0});
  expect_outward({left, right}, [](const Point& p) -> Point {
    return p.x() > 20.5 ? Point(p - Point(41, 0, 0)) : p;
  });
}

TEST(Orient, ABodyAndItsShiftedInvertedCopyBothFaceOutward) {
  // Their windings sum up to zero everywhere.
  const Point shift(0.01, 0.003, 0.002);
  const Model ball = sample::icosphere(20, 4);
  expect_outward({ball, moved(ball, shift)}, radial);
  expect_outward({ball_with_holes(), moved(ball_with_holes(), shift)}, radial);
}

TEST(Orient, AnOpenShellInsideAClosedOneFacesOutward) {
  expect_outward({sample::icosphere(30, 4), ball_with_holes()}, radial);
}

TEST(Orient, NestedClosedShellsAlternateOnlyIfTheFileSaysSo) {
  const Model outer = sample::icosphere(30, 3), wall = sample::icosphere(20, 3),
              core = sample::icosphere(10, 3);
  const auto sides = [](const Model& model) {
    std::vector<double> out;
    for (const double r : {30.0, 20.0, 10.0}) {
      Surface s = surface_of(model);
      std::erase_if(s.triangles, [&](const Eigen::Vector3i& t) {
        return std::abs(s.points[t[0]].norm() - r) > 1;
      });
      out.push_back(outward_share(s, radial));
    }
    return out;
  };
  using Sides = std::vector<double>;
  const Model hollow = together({outer, inside_out(wall), core});
  EXPECT_EQ(sides(hollow), (Sides{1, 0, 1}));
  EXPECT_EQ(sides(inside_out(hollow)), (Sides{1, 0, 1}));
  // Within the cavity there is no solid in which a second cavity could be.
  EXPECT_EQ(sides(together({outer, inside_out(wall), inside_out(core)})), (Sides{1, 0, 1}));
  EXPECT_EQ(sides(together({outer, wall, core})), (Sides{1, 1, 1}));
}

TEST(Orient, APartTurnedOverDoesNotTurnTheCavityOfAnother) {
  // The second part is larger, so the volumes of all add up to less than zero.
  const Model small = sample::icosphere(10, 3), cavity = inside_out(sample::icosphere(5, 3)),
              large = inside_out(moved(sample::icosphere(30, 3), {50, 0, 0}));
  const Surface surface = surface_of(together({small, cavity, large}));
  ASSERT_EQ(surface.shells.size(), 3U);
  EXPECT_TRUE(surface.shells[0].turned_over);
  EXPECT_EQ(surface.shells[2].rule, SideRule::kCavity);
  EXPECT_FALSE(surface.shells[2].turned_over);
}

TEST(Orient, AnInvertedPartThatSticksOutIsNoCavity) {
  const Model ball = sample::icosphere(20, 3);
  expect_outward({ball, moved(sample::icosphere(10, 3), {15, 0, 0})}, [](const Point& p) -> Point {
    return std::abs(p.norm() - 20) < 0.5 && (p - Point(15, 0, 0)).norm() > 10.01
               ? p
               : Point(p - Point(15, 0, 0));
  });
}

TEST(Orient, ABoxOfSixSeparateFacesFacesOutward) {
  std::vector<Model> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Model face;
      const Point n = sign * 10.01 * Point::Unit(axis);
      const Point a = 10 * Point::Unit((axis + 1) % 3), b = 10 * Point::Unit((axis + 2) % 3);
      face.vertices = {n - a - b, n + a - b, n + a + b, n - a + b};
      face.triangles = {{0, 1, 2}, {0, 2, 3}};  // half of the faces look inward
      faces.push_back(face);
    }
  }
  const Surface surface = surface_of(together(faces));
  EXPECT_EQ(outward_share(surface, radial), 1);
  EXPECT_FALSE(surface.is_flat);
}

TEST(Orient, AFlatSheetIsUndecidedAndStaysAsInTheFile) {
  Model sheet;
  sheet.vertices = {{0, 0, 0}, {30, 0, 0}, {30, 30, 0}, {0, 30, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const double up : {1.0, -1.0}) {
    const Surface surface = surface_of(up > 0 ? sheet : inside_out(sheet));
    EXPECT_EQ(outward_share(surface, [&](const Point&) { return Point(0, 0, up); }), 1);
    ASSERT_EQ(surface.shells.size(), 1U);
    EXPECT_EQ(surface.shells[0].rule, SideRule::kUndecided);
    EXPECT_NE(warning(surface, WarningCode::SIDES_BY_RAYS).find("Close the holes"),
              std::string::npos);
    EXPECT_TRUE(surface.is_flat);
  }
}

TEST(Orient, SizeDoesNotMatter) {
  const Model model =
      together({inside_out(ball_with_holes()), moved(ball_with_holes(), {41, 0, 0})});
  const Surface normal = surface_of(model);
  for (const double factor : {10'000.0 / 60, 0.01 / 60, 1e-6}) {
    const Surface other = surface_of(scaled(model, factor));
    EXPECT_EQ(other.triangles, normal.triangles);
    ASSERT_EQ(other.shells.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(other.shells[i].area_mm2, factor * factor * normal.shells[i].area_mm2,
                  1e-9 * other.shells[i].area_mm2);
  }
}

TEST(Orient, ResultDoesNotDependOnTheNumberOfThreads) {
  std::vector<Model> parts;
  for (int i = 0; i < 20; ++i) {
    const Model part = moved(ball_with_holes(3 + i % 3), {7.0 * (i % 5), 7.0 * (i / 5), 0});
    parts.push_back(i % 2 == 0 ? part : inside_out(part));
  }
  Context one, three;
  three.threads = 3;
  const auto single = make_surface(together(parts), 1e9, one);
  const auto parallel = make_surface(together(parts), 1e9, three);
  ASSERT_TRUE(single && parallel);
  EXPECT_EQ(single->triangles, parallel->triangles);
}

TEST(Orient, OnlyTheLargestShellsAreListedLargestFirst) {
  std::vector<Model> balls;
  for (int i = 0; i < 12; ++i)
    balls.push_back(moved(sample::icosphere(1 + i, 1), {30.0 * i, 0, 0}));
  const Surface surface = surface_of(together(balls));
  ASSERT_EQ(surface.shells.size(), kShellsListed);
  EXPECT_EQ(surface.shells[0].triangles, 80U);
  EXPECT_TRUE(surface.shells[0].closed);
  EXPECT_EQ(surface.shells[0].rule, SideRule::kVolume);
  for (std::size_t i = 1; i < kShellsListed; ++i)
    EXPECT_GT(surface.shells[i - 1].area_mm2, surface.shells[i].area_mm2);
}

TEST(Orient, ScansComeOutTheSameInBothOrientations) {
  for (const char* file : {"bunny/bunny_with_uv.obj", "bottle/WaterBottle_converted.obj"}) {
    const auto path = testing::model_path(file);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " does not exist";
    const Model model = read(path, 1000);
    const Surface own = surface_of(model), reversed = surface_of(inside_out(model));
    ASSERT_EQ(own.triangles.size(), reversed.triangles.size());
    std::size_t different = 0;
    for (std::size_t t = 0; t < own.triangles.size(); ++t) {
      const auto normal = [&](const Surface& s) -> Point {
        const auto& v = s.triangles[t];
        return (s.points[v[1]] - s.points[v[0]]).cross(s.points[v[2]] - s.points[v[0]]);
      };
      different += normal(own).dot(normal(reversed)) > 0 ? 0 : 1;
    }
    EXPECT_EQ(different, 0U) << file;
    EXPECT_EQ(own.triangles, model.triangles) << file;
  }
}

TEST(Orient, StopsWhenCancelled) {
  const Model model = ball_with_holes();
  std::vector<int> weld(model.vertices.size());
  for (std::size_t i = 0; i < weld.size(); ++i) weld[i] = static_cast<int>(i);
  Context context;
  context.cancelled = [] { return true; };
  const auto result =
      orient(model.vertices, weld, model.triangles, Edges(model.triangles, weld), context);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Code::kCancelled);
}

TEST(RayTree, FindsTheTrianglesThatBruteForceFinds) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] { return Point(uniform(random), uniform(random), uniform(random)); };
  std::vector<Corners> triangles(300);
  for (Corners& c : triangles) c = {point(), point(), point()};
  const RayTree tree(triangles);
  std::vector<RayHit> hits;
  for (int ray = 0; ray < 200; ++ray) {
    const Point origin = point(), direction = point();
    tree.find_hits(origin, direction, hits);
    std::ranges::sort(hits, {}, &RayHit::triangle);
    std::size_t next = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      // origin + s direction = a + u (b - a) + v (c - a)
      const auto& [a, b, c] = triangles[t];
      Eigen::Matrix3d m;
      m << direction, a - b, a - c;
      const Point x = m.fullPivLu().solve(a - origin);
      if (x[0] <= 0 || x[1] <= 0 || x[2] <= 0 || x[1] + x[2] >= 1) continue;
      ASSERT_LT(next, hits.size());
      EXPECT_EQ(hits[next].triangle, t);
      EXPECT_EQ(hits[next].from_behind, (b - a).cross(c - a).dot(direction) > 0);
      ++next;
    }
    EXPECT_EQ(next, hits.size());
  }
}

std::vector<Corners> corners_of(const Model& model) {
  std::vector<Corners> out;
  for (const auto& t : model.triangles)
    out.push_back({model.vertices[t[0]], model.vertices[t[1]], model.vertices[t[2]]});
  return out;
}

TEST(ParallelRays, CountHowOftenBallsWindAroundPoints) {
  // Two balls that overlap, a cavity in one of them, and a tiny ball, whose triangles all lie in
  // one place.
  const Model left = sample::icosphere(20, 4), right = moved(left, {20, 0, 0}),
              cavity = inside_out(sample::icosphere(5, 3)),
              grain = moved(sample::icosphere(0.01, 4), {0, 0, 15});
  const ParallelRays rays(corners_of(together({left, right, cavity, grain})));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto expect_winding = [&](const Point& p) {
    int expected = 0;
    for (const auto& [middle, radius, sign] :
         {std::tuple(Point(0, 0, 0), 20.0, 1), std::tuple(Point(20, 0, 0), 20.0, 1),
          std::tuple(Point(0, 0, 0), 5.0, -1), std::tuple(Point(0, 0, 15), 0.01, 1)}) {
      const double r = (p - middle).norm() / radius;
      if (std::abs(r - 1) < 0.02) return;  // between the sphere and its triangles
      expected += r < 1 ? sign : 0;
    }
    EXPECT_EQ(rays.winding(p), expected) << p.transpose();
  };
  for (int i = 0; i < 4000; ++i) {
    const Point p(any(random), any(random), any(random));
    expect_winding(45 * p);
    expect_winding(Point(0, 0, 15) + 0.02 * p);
  }
}

}  // namespace
}  // namespace hydroprint::mesh
