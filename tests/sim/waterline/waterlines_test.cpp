#include "sim/waterline/waterlines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/sample/icosphere.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::waterline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

film::Outline outline_of(const std::string& text) { return film::parse_outline(text).value(); }

Waterlines taken(const mesh::Model& model, const std::string& film = "A4",
                 const Motion& motion = {}) {
  const Body body = testing::body_of(model);
  auto lines = take_waterlines(body, outline_of(film), body.height_mm, motion, {}, {});
  if (!lines) {
    ADD_FAILURE() << lines.error().message;
    return {};
  }
  return *lines;
}

/// The last waterline before the given immersion.
const Waterline& before(const Waterlines& waterlines, double immersion_mm) {
  const Waterline* found = &waterlines.lines.front();
  for (const Waterline& line : waterlines.lines) {
    if (line.immersion_mm < immersion_mm) found = &line;
  }
  return *found;
}

int loops(const Waterline& line, bool is_hole, bool bounds_film) {
  int count = 0;
  for (std::size_t l = 0; l < line.section.size(); ++l) {
    count += line.section[l].is_hole == is_hole && (line.bounds_film[l] != 0) == bounds_film;
  }
  return count;
}

void expect_loops(const Waterline& line, int outer_film, int hole_film, int outer_dry,
                  int hole_dry) {
  EXPECT_EQ(loops(line, false, true), outer_film) << line.immersion_mm;
  EXPECT_EQ(loops(line, true, true), hole_film) << line.immersion_mm;
  EXPECT_EQ(loops(line, false, false), outer_dry) << line.immersion_mm;
  EXPECT_EQ(loops(line, true, false), hole_dry) << line.immersion_mm;
}

TEST(Waterlines, ACupMouthDownWithAVentHoldsFilm) {
  const Waterlines w = taken(testing::cup(15, 20, 30, 5, false, 48, 2));
  for (const Waterline& line : w.lines) expect_loops(line, 1, 1, 0, 0);
  EXPECT_GT(w.lines.size(), 10U);
  EXPECT_FALSE(w.stopped_at_edge);
  EXPECT_NEAR(w.depth_mm, 30, 1e-9);
}

TEST(Waterlines, ACupMouthDownWithoutAVentHoldsNoFilm) {
  const Waterlines w = taken(testing::cup(15, 20, 30, 5, false, 48));
  for (const Waterline& line : w.lines) {
    expect_loops(line, 1, 0, 0, line.immersion_mm < 25 ? 1 : 0);
  }
}

TEST(Waterlines, ACupMouthUpHoldsNoFilm) {
  const Waterlines w = taken(testing::cup(15, 20, 30, 5, true, 48));
  for (const Waterline& line : w.lines) {
    expect_loops(line, 1, 0, 0, line.immersion_mm < 5 ? 0 : 1);
  }
}

TEST(Waterlines, ARingEnclosesFilm) {
  const Waterlines w = taken(testing::torus(25, 8, 64, 32));
  for (const Waterline& line : w.lines) expect_loops(line, 1, 1, 0, 0);
}

TEST(Waterlines, TwoFeetBecomeOneAtTheBridge) {
  const Waterlines w = taken(testing::blocks({-20, -10, 10, 20}, {-8, 8}, {0, 25, 35},
                                             [](int i, int, int k) { return k == 1 || i != 1; }));
  expect_loops(w.lines.front(), 2, 0, 0, 0);
  expect_loops(before(w, 25), 2, 0, 0, 0);
  EXPECT_GT(before(w, 25).immersion_mm, 24.99);
  for (const Waterline& line : w.lines) {
    if (line.immersion_mm > 25) expect_loops(line, 1, 0, 0, 0);
  }
}

TEST(Waterlines, APostInTrappedFilmIsAnIslandThatBoundsFilm) {
  const mesh::Model ring = testing::turned({{25, 30}, {25, 0}, {30, 0}, {30, 30}}, 48);
  const Waterlines w = taken(testing::together({ring, testing::cylinder(6, 26, 24)}));
  expect_loops(before(w, 25), 2, 1, 0, 0);
}

TEST(Waterlines, APostInTrappedAirBoundsNoFilm) {
  const Waterlines w = taken(
      testing::together({testing::cup(25, 30, 30, 5, false, 48), testing::cylinder(6, 26, 24)}));
  expect_loops(before(w, 25), 1, 0, 1, 1);
}

TEST(Waterlines, APostInACupMouthUpBoundsNoFilm) {
  const Waterlines w =
      taken(testing::together({testing::cup(25, 30, 30, 5, true, 48),
                               testing::moved(testing::cylinder(6, 22, 24), {0, 0, 3})}));
  expect_loops(before(w, 24), 1, 0, 1, 1);
  expect_loops(before(w, 30), 1, 0, 0, 1);
}

TEST(Waterlines, ACavityAboveAClosedCeilingStaysDry) {
  // Three layers of cells: a frame that is open at the bottom, a floor, and a frame that is open at
  // the top.
  const Waterlines w =
      taken(testing::blocks({-20, -12, 12, 20}, {-20, -12, 12, 20}, {0, 10, 15, 25},
                            [](int i, int j, int k) { return k == 1 || i != 1 || j != 1; }));
  expect_loops(before(w, 10), 1, 0, 0, 1);
  expect_loops(before(w, 15), 1, 0, 0, 0);
  expect_loops(before(w, 25), 1, 0, 0, 1);
}

TEST(Waterlines, FilmIsTrappedWhenARingClosesAroundIt) {
  // A ring with a gap in its side up to 12 mm height.
  const Waterlines w = taken(
      testing::blocks({-20, -12, 12, 20}, {-20, -12, 12, 20}, {0, 12, 25}, [](int i, int j, int k) {
        if (i == 1 && j == 1) return false;
        return k == 1 || i != 2 || j != 1;
      }));
  expect_loops(before(w, 12), 1, 0, 0, 0);
  expect_loops(before(w, 25), 1, 1, 0, 0);
}

TEST(Waterlines, ADryCavityStaysDryWhileItNarrowsAndWidens) {
  // A vase with its mouth up. Its inner radius goes from 15 mm to 8 mm and back.
  const Waterlines w =
      taken(testing::turned({{0, 0}, {25, 0}, {25, 40}, {15, 40}, {8, 22}, {15, 5}, {0, 5}}, 48));
  for (const Waterline& line : w.lines) {
    if (line.immersion_mm > 5 && line.immersion_mm < 40) expect_loops(line, 1, 0, 0, 1);
  }
}

TEST(Waterlines, AreCloserWhereContoursMerge) {
  // Two overlapping spheres, whose contours merge at some depth.
  const double radius = 20, apart = 16;
  const Waterlines w =
      taken(testing::together({testing::moved(sample::icosphere(radius, 5), {apart, 0, 0}),
                               testing::moved(sample::icosphere(radius, 5), {-apart, 0, 0})}));
  const double merge_mm = radius - std::sqrt(radius * radius - apart * apart);
  const double slit_mm = radius - std::sqrt(radius * radius - std::pow(apart - 0.15, 2));
  bool found = false;
  for (std::size_t i = 1; i < w.lines.size(); ++i) {
    if (loops(w.lines[i - 1], false, true) == 2 && loops(w.lines[i], false, true) == 1) {
      // No film fits between the spheres when their gap is narrower than a slit (0.3 mm).
      EXPECT_LE(w.lines[i].immersion_mm, merge_mm + 0.02);
      EXPECT_GE(w.lines[i].immersion_mm, slit_mm - 0.02);
      EXPECT_LE(w.lines[i].immersion_mm - w.lines[i - 1].immersion_mm, 0.0101);
      found = true;
    }
  }
  EXPECT_TRUE(found);
}

TEST(Waterlines, TheDipEndsWhereTheWaterlineReachesTheFilm) {
  const double slope = std::numbers::pi / 4;
  // A ridge along y with slopes of 45 degrees, so its waterline is at x = +-immersion.
  const Waterlines w = taken(testing::wedge(slope, 60, 30), "80x120");
  EXPECT_TRUE(w.stopped_at_edge);
  EXPECT_NEAR(w.depth_mm, 40, 0.06);  // the edge counts as reached slightly early
  EXPECT_LT(w.depth_mm, 40 + 1e-9);
  ASSERT_FALSE(w.lines.empty());
  EXPECT_LE(w.lines.back().immersion_mm, w.depth_mm);
  EXPECT_GT(w.lines.back().immersion_mm, w.depth_mm - 2e-3);
  const film::Outline film = outline_of("80x120");
  for (const Waterline& line : w.lines) {
    for (const Loop& loop : line.section) {
      for (const Vector2d& p : loop.points_mm) EXPECT_TRUE(film::contains(film, p));
    }
  }
}

TEST(Waterlines, AFlatBottomLargerThanTheFilmEndsTheDipAtOnce) {
  const Waterlines w = taken(testing::box({-60, -60, 0}, {60, 60, 20}), "80x80");
  EXPECT_TRUE(w.stopped_at_edge);
  EXPECT_LT(w.depth_mm, 0.01);
}

TEST(Waterlines, AFirstContactThatMissesTheFilmIsRefused) {
  const film::Outline film = outline_of("80x80");
  for (const Vector3d& at : {Vector3d(60, 0, 0), Vector3d(0, -70, 0), Vector3d(500, 500, 0)}) {
    const Body body = testing::body_of(testing::moved(sample::icosphere(15, 3), at));
    const auto lines = take_waterlines(body, film, body.height_mm, {}, {}, {});
    ASSERT_FALSE(lines);
    EXPECT_EQ(lines.error().code, Code::kFailedPrecondition);
    EXPECT_EQ(lines.error().reason, ErrorReason::CONTACT_MISSES_FILM);
    EXPECT_EQ(lines.error().message.find('\n'), std::string::npos);
  }
}

TEST(Waterlines, AFirstContactInARingAroundTheFilmIsRefused) {
  const Body body = testing::body_of(testing::cup(70, 80, 30, 5, false, 48));
  const auto lines = take_waterlines(body, outline_of("80x80"), body.height_mm, {}, {}, {});
  ASSERT_FALSE(lines);
  EXPECT_EQ(lines.error().code, Code::kFailedPrecondition);
}

TEST(Waterlines, AMotionThatMovesFirstContactOffTheFilmIsRefused) {
  Motion motion;
  motion.rows = {{0, 0, {55, 0}}, {1, 5, {55, 0}}};
  const Body body = testing::body_of(sample::icosphere(15, 3));
  EXPECT_FALSE(take_waterlines(body, outline_of("80x80"), body.height_mm, motion, {}, {}));
}

TEST(Waterlines, FollowTheMotionAndItsDrift) {
  Motion motion;
  motion.rows = {{0, 0, {0, 0}}, {2, 10, {0, 0}}, {4, 20, {5, -3}}, {6, 30, {5, -3}}};
  const mesh::Model model = testing::cylinder(15, 40, 48);
  const Waterlines straight = taken(model);
  const Waterlines strayed = taken(model, "A4", motion);
  ASSERT_EQ(straight.lines.size(), strayed.lines.size());
  for (std::size_t i = 0; i < strayed.lines.size(); ++i) {
    const double z = strayed.lines[i].immersion_mm;
    const Vector2d offset = Vector2d(5, -3) * std::clamp((z - 10) / 10, 0.0, 1.0);
    const Vector2d drift = z > 10 && z <= 20 ? Vector2d(0.5, -0.3) : Vector2d(0, 0);
    EXPECT_LT((offset_at(motion, z) - offset).norm(), 1e-12);
    EXPECT_LT((drift_at(motion, z) - drift).norm(), 1e-12) << z;
    for (const double angle : {0.0, 1.0, 4.0}) {
      const Vector2d at(15 * std::cos(angle), 15 * std::sin(angle));
      const Vector2d expected = straight.lines[i].pulls.at(at) + drift;
      EXPECT_LT((strayed.lines[i].pulls.at(at + offset) - expected).norm(), 1e-9);
    }
    EXPECT_LT((strayed.lines[i].section[0].points_mm[0] - offset).norm(), 15.1);
    EXPECT_GT((strayed.lines[i].section[0].points_mm[0] - offset).norm(), 14.8);
  }
}

TEST(Motion, IsConstantBeforeItsFirstAndAfterItsLastRow) {
  Motion motion;
  motion.rows = {{0, 2, {1, 1}}, {1, 4, {2, 3}}, {1, 4, {2, 4}}};
  EXPECT_EQ(offset_at(motion, 0), Vector2d(1, 1));
  EXPECT_EQ(drift_at(motion, 0), Vector2d(0, 0));
  EXPECT_EQ(offset_at(motion, 9), Vector2d(2, 4));
  EXPECT_EQ(drift_at(motion, 9), Vector2d(0, 0));
  EXPECT_EQ(offset_at(motion, 3), Vector2d(1.5, 2));
  EXPECT_TRUE(offset_at(motion, 4).allFinite());
  EXPECT_TRUE(drift_at(motion, 4).allFinite());
  EXPECT_EQ(offset_at({}, 3), Vector2d(0, 0));
}

TEST(Waterlines, AreNotMoreThanTheLimitAndSayWhereTheyAreCoarse) {
  // Pins of different lengths under a plate: each contact changes the topology.
  std::vector<mesh::Model> pins = {testing::box({-50, -50, 30}, {50, 50, 34})};
  for (int i = 0; i < 25; ++i) {
    const Vector3d at(-44 + 22.0 * (i % 5), -44 + 22.0 * (i / 5), 1.1 * i);
    pins.push_back(testing::box(at, {at.x() + 4, at.y() + 4, 31}));
  }
  const Body body = testing::body_of(testing::together(pins));
  ScheduleOptions options;
  const auto all = take_waterlines(body, outline_of("A4"), body.height_mm, {}, options, {});
  ASSERT_TRUE(all);
  EXPECT_FALSE(all->coarse.any());
  options.most = all->lines.size() / 2;
  const auto half = take_waterlines(body, outline_of("A4"), body.height_mm, {}, options, {});
  ASSERT_TRUE(half);
  EXPECT_LE(half->lines.size(), options.most);
  EXPECT_TRUE(half->coarse.any());
  const std::vector<Gap>& gaps = half->coarse.unresolved;
  for (std::size_t i = 1; i < gaps.size(); ++i) {
    EXPECT_GE(gaps[i - 1].width_mm(), gaps[i].width_mm());
  }
}

TEST(Waterlines, StopWhenCancelled) {
  Context context;
  context.cancelled = [] { return true; };
  const Body body = testing::body_of(sample::icosphere(20, 3));
  const auto lines = take_waterlines(body, outline_of("A4"), 40, {}, {}, context);
  ASSERT_FALSE(lines);
  EXPECT_EQ(lines.error().code, Code::kCancelled);
}

TEST(Waterlines, AreTheSameForAnyNumberOfThreads) {
  const Body body = testing::body_of(testing::torus(25, 8, 48, 24));
  const auto run = [&](int threads) {
    Context context;
    context.threads = threads;
    return take_waterlines(body, outline_of("A4"), body.height_mm, {}, {}, context).value();
  };
  const Waterlines one = run(1), three = run(3);
  ASSERT_EQ(one.lines.size(), three.lines.size());
  for (std::size_t i = 0; i < one.lines.size(); ++i) {
    EXPECT_EQ(one.lines[i].immersion_mm, three.lines[i].immersion_mm);
    ASSERT_EQ(one.lines[i].section.size(), three.lines[i].section.size());
    for (std::size_t l = 0; l < one.lines[i].section.size(); ++l) {
      EXPECT_EQ(one.lines[i].section[l].points_mm, three.lines[i].section[l].points_mm);
    }
  }
}

TEST(FilmCurves, AreTheFilmsEdgeAndTheLoopsThatBoundFilm) {
  const film::Outline film = outline_of("A4");
  const Waterlines w =
      taken(testing::together({testing::cup(25, 30, 30, 5, true, 48),
                               testing::moved(testing::cylinder(6, 22, 24), {0, 0, 3})}));
  const auto curves = film_curves(film, before(w, 24));
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_EQ(curves[0], film.polygon);
  EXPECT_NEAR(signed_area(curves[1]), std::numbers::pi * 900, 15);
}

}  // namespace
}  // namespace hydroprint::waterline
