#include "sim/waterline/cross_section.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <numbers>
#include <random>

namespace hydroprint::waterline {
namespace {

using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

Polygon box(double left, double low, double right, double high) {
  return {{left, low}, {right, low}, {right, high}, {left, high}};
}

Polygon circle(const Vector2d& centre, double radius, int points, double start_rad = 0) {
  Polygon polygon;
  for (int i = 0; i < points; ++i) {
    const double angle = start_rad + 2 * std::numbers::pi * i / points;
    polygon.emplace_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

Polygon reversed(Polygon polygon) {
  std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

CrossSection united(const std::vector<Polygon>& polygons) {
  std::vector<Contour> contours;
  for (const Polygon& polygon : polygons) {
    Contour contour;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      contour.push_back({polygon[i], polygon[(i + 1) % polygon.size()], {0, 0}, {0, 0}});
    }
    contours.push_back(contour);
  }
  return unite(contours);
}

double area_of(const CrossSection& section) {
  double area = 0;
  for (const Loop& loop : section) area += signed_area(loop.points_mm);
  return area;
}

std::size_t points_of(const CrossSection& section) {
  std::size_t points = 0;
  for (const Loop& loop : section) points += loop.points_mm.size();
  return points;
}

int winding(const Polygon& polygon, const Vector2d& p) {
  int turns = 0;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vector2d& a = polygon[j];
    const Vector2d& b = polygon[i];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    const double x = a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y());
    if (p.x() < x) turns += b.y() > a.y() ? 1 : -1;
  }
  return turns;
}

int winding(const std::vector<Polygon>& polygons, const Vector2d& p) {
  int turns = 0;
  for (const Polygon& polygon : polygons) turns += winding(polygon, p);
  return turns;
}

double distance(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - p).norm();
}

double distance(const Vector2d& p, const Polygon& polygon) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    least = std::min(least, distance(p, polygon[j], polygon[i]));
  }
  return least;
}

/// The least distance between curves, found from their corners. They must not cross.
double gap_between(const Polygon& p, const Polygon& q) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector2d& corner : p) least = std::min(least, distance(corner, q));
  for (const Vector2d& corner : q) least = std::min(least, distance(corner, p));
  return least;
}

bool cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const auto side = [](const Vector2d& p, const Vector2d& q, const Vector2d& r) {
    return (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x();
  };
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

/// Expects simple curves that do not cross, turned and nested as their flags say.
void expect_valid(const CrossSection& section) {
  std::vector<std::pair<Vector2d, Vector2d>> lines;
  for (std::size_t l = 0; l < section.size(); ++l) {
    const Loop& loop = section[l];
    const Polygon& points = loop.points_mm;
    ASSERT_GE(points.size(), 3U);
    EXPECT_EQ(signed_area(points) < 0, loop.is_hole);
    ASSERT_LT(loop.parent, static_cast<int>(l)) << "parents come first";
    ASSERT_GE(loop.parent, loop.is_hole ? 0 : -1);
    if (loop.parent >= 0) {
      EXPECT_NE(section[loop.parent].is_hole, loop.is_hole);
      EXPECT_NE(winding(section[loop.parent].points_mm, points[0]), 0);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = i + 1; j < points.size(); ++j) EXPECT_NE(points[i], points[j]);
      lines.emplace_back(points[i], points[(i + 1) % points.size()]);
    }
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      EXPECT_FALSE(cross(lines[i].first, lines[i].second, lines[j].first, lines[j].second));
    }
  }
}

/// Expects that the section is solid where the winding number is not zero, except within a slit's
/// width of a curve.
void expect_winding_rule(const std::vector<Polygon>& polygons, const CrossSection& section,
                         std::mt19937& random) {
  std::uniform_real_distribution<double> place(-1, 41);
  for (int i = 0; i < 200; ++i) {
    const Vector2d p(place(random), place(random));
    double away = std::numeric_limits<double>::infinity();
    for (const Polygon& polygon : polygons) away = std::min(away, distance(p, polygon));
    const bool is_solid = winding(polygons, p) != 0;
    if (away > (is_solid ? 0.01 : 0.3)) {
      EXPECT_EQ(is_inside(section, p), is_solid) << p.transpose();
    }
  }
}

/// Random closed curves, which cross themselves and each other.
/// @param on_grid  places corners on a coarse grid, so that many edges touch or coincide
std::vector<Polygon> tangle(std::mt19937& random, bool on_grid) {
  std::uniform_real_distribution<double> place(0, 40);
  std::uniform_int_distribution<int> step(0, 8);
  std::vector<Polygon> polygons(1 + random() % 4);
  for (Polygon& polygon : polygons) {
    polygon.resize(3 + random() % 12);
    for (Vector2d& p : polygon) {
      p = on_grid ? Vector2d(5 * step(random), 5 * step(random))
                  : Vector2d(place(random), place(random));
    }
  }
  return polygons;
}

TEST(Unite, TanglesAreSolidWhereTheWindingNumberIsNotZero) {
  std::mt19937 random(4);
  for (int i = 0; i < 60; ++i) {
    std::vector<Polygon> polygons = tangle(random, i % 2 == 0);
    if (i % 3 == 0) polygons.push_back(polygons.front());            // given twice
    if (i % 5 == 0) polygons.push_back(reversed(polygons.front()));  // cancelled
    const CrossSection section = united(polygons);
    expect_valid(section);
    expect_winding_rule(polygons, section, random);
  }
}

TEST(Unite, ARegionIsItsOwnUnion) {
  std::mt19937 random(8);
  for (int i = 0; i < 30; ++i) {
    const CrossSection once = united(tangle(random, i % 2 == 0));
    std::vector<Polygon> loops;
    for (const Loop& loop : once) loops.push_back(loop.points_mm);
    const CrossSection twice = united(loops);
    EXPECT_NEAR(area_of(twice), area_of(once), 0.05 * static_cast<double>(once.size()));
    std::vector<Polygon> doubled = loops;
    doubled.insert(doubled.end(), loops.begin(), loops.end());
    EXPECT_NEAR(area_of(united(doubled)), area_of(twice), 1e-6);
  }
}

TEST(Unite, KeepsASimpleCurveWithItsCollinearPoints) {
  Polygon polygon;
  for (int i = 0; i < 40; ++i) polygon.emplace_back(i, 0);
  for (int i = 0; i < 40; ++i) polygon.emplace_back(40, 0.5 * i);
  for (int i = 0; i < 40; ++i) polygon.emplace_back(40 - i, 20 - 0.5 * i);
  for (const Polygon& given : {polygon, reversed(polygon)}) {
    const CrossSection section = united({given});
    ASSERT_EQ(section.size(), 1U);
    EXPECT_FALSE(section[0].is_hole);
    EXPECT_NEAR(area_of(section), 400, 1e-9);
    EXPECT_EQ(section[0].points_mm.size(), polygon.size());
  }
}

TEST(Unite, CopiesOfACurveCountAsOne) {
  const Polygon one = circle({0, 0}, 20, 200);
  const CrossSection expected = united({one});
  for (const std::vector<Polygon>& copies :
       {std::vector<Polygon>{one, one}, {one, one, one}, {reversed(one), reversed(one)}}) {
    const CrossSection section = united(copies);
    ASSERT_EQ(section.size(), 1U);
    EXPECT_EQ(section[0].points_mm.size(), one.size());
    EXPECT_DOUBLE_EQ(area_of(section), area_of(expected));
  }
  EXPECT_TRUE(united({one, reversed(one)}).empty());
}

TEST(Unite, TilesBecomeOneCurve) {
  std::vector<Polygon> tiles;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) tiles.push_back(box(3 * i, 3 * j, 3 * i + 3, 3 * j + 3));
  }
  const CrossSection section = united(tiles);
  ASSERT_EQ(section.size(), 1U);
  EXPECT_NEAR(area_of(section), 3600, 1e-6);
  EXPECT_EQ(section[0].points_mm.size(), 80U);
}

TEST(Unite, SquaresThatTouchAtCornersAreJoinedIntoSimpleCurves) {
  std::vector<Polygon> squares;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      if ((i + j) % 2 == 0) squares.push_back(box(3 * i, 3 * j, 3 * i + 3, 3 * j + 3));
    }
  }
  const CrossSection section = united(squares);
  expect_valid(section);
  EXPECT_EQ(std::count_if(section.begin(), section.end(), [](const Loop& l) { return !l.is_hole; }),
            1);
  EXPECT_EQ(section.size(), 1U + 18U);  // the open squares that do not touch the outside
  EXPECT_NEAR(area_of(section), 32 * 9, 49 * 0.09 + 0.01);
}

TEST(Unite, HundredsOfEdgesOnOneLineLoseNoArea) {
  std::vector<Polygon> boxes;
  for (int i = 0; i < 300; ++i) boxes.push_back(box(0.01 * i, 0, 40 + 0.01 * i, 20 + 1e-5 * i));
  const CrossSection section = united(boxes);
  ASSERT_EQ(section.size(), 1U);
  EXPECT_NEAR(area_of(section), 42.99 * 20, 0.15);
}

TEST(Unite, ShellsOfOppositeWindingCancelOnlyWhereTheyOverlap) {
  const CrossSection section = united({box(0, 0, 10, 10), reversed(box(5, 0, 15, 10))});
  EXPECT_NEAR(area_of(section), 100, 1e-6);
  EXPECT_TRUE(is_inside(section, {2, 5}));
  EXPECT_FALSE(is_inside(section, {7, 5}));
  EXPECT_TRUE(is_inside(section, {12, 5}));
}

TEST(Unite, NestsDisjointCurvesOfAnyDirection) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> place(5, 35), size(0.5, 15);
  for (int i = 0; i < 20; ++i) {
    struct Disc {
      Vector2d centre;
      double radius;
    };
    std::vector<Disc> discs;
    std::vector<Polygon> polygons;
    for (int attempt = 0; attempt < 300; ++attempt) {
      const Disc disc = {{place(random), place(random)}, size(random)};
      const bool is_apart = std::all_of(discs.begin(), discs.end(), [&](const Disc& other) {
        const double away = (disc.centre - other.centre).norm();
        return away > disc.radius + other.radius + 0.4 ||
               away < std::abs(disc.radius - other.radius) - 0.4;
      });
      if (!is_apart) continue;
      discs.push_back(disc);
      polygons.push_back(circle(disc.centre, disc.radius, 20 + attempt % 60));
      if (random() % 2 == 0) polygons.back() = reversed(polygons.back());
    }
    const CrossSection section = united(polygons);
    EXPECT_LE(section.size(), polygons.size());
    expect_valid(section);
    expect_winding_rule(polygons, section, random);
  }
}

TEST(Unite, NestedCurvesOfOneDirectionAreOneSolid) {
  std::vector<Polygon> rings;
  for (int i = 0; i < 50; ++i) rings.push_back(circle({0, 0}, 1 + 0.5 * i, 40));
  const CrossSection section = united(rings);
  ASSERT_EQ(section.size(), 1U);
  EXPECT_DOUBLE_EQ(area_of(section), area_of(united({rings.back()})));
}

TEST(Unite, NoFilmFitsBetweenPartsLessThanASlitApart) {
  for (const double gap_mm : {0.0, 1e-6, 0.007, 0.1, 0.29}) {
    const CrossSection section = united({box(0, 0, 40, 40), box(40 + gap_mm, 5, 80, 35)});
    ASSERT_EQ(section.size(), 1U) << gap_mm;
    expect_valid(section);
    EXPECT_NEAR(area_of(section), 1600 + 30 * 40, 0.1) << gap_mm;
    EXPECT_TRUE(is_inside(section, {40 + 0.5 * gap_mm, 20}));
  }
  EXPECT_EQ(united({box(0, 0, 40, 40), box(40.31, 5, 80, 35)}).size(), 2U);
}

TEST(Unite, ASlitIsClosedOnlyWhereItIsNarrow) {
  for (const int points : {40, 400, 4000}) {
    const Polygon left = circle({-20, 0}, 20, points), right = circle({20.05, 0}, 20, points);
    const CrossSection section = united({left, right});
    ASSERT_EQ(section.size(), 1U);
    expect_valid(section);
    // The chords of a coarse circle move its edge by up to 0.06 mm.
    const double half_mm = std::sqrt(20 * 20 - std::pow(20 - 0.125, 2));
    EXPECT_TRUE(is_inside(section, {0.025, 0.8 * half_mm}));
    EXPECT_FALSE(is_inside(section, {0.025, 1.4 * half_mm}));
    EXPECT_NEAR(area_of(section), signed_area(left) + signed_area(right), 1.4 * 2 * half_mm * 0.3);
  }
}

TEST(Unite, CurvesOfASectionAreASlitApart) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> place(0, 40), size(1, 4);
  for (int i = 0; i < 20; ++i) {
    std::vector<Polygon> discs;
    for (int d = 0; d < 60; ++d) {
      discs.push_back(circle({place(random), place(random)}, size(random), 30 + 20 * (d % 5)));
    }
    const CrossSection section = united(discs);
    expect_valid(section);
    for (std::size_t l = 0; l < section.size(); ++l) {
      for (std::size_t m = l + 1; m < section.size(); ++m) {
        const bool open_between =
            section[l].is_hole ? section[m].parent == static_cast<int>(l) : !section[m].is_hole;
        if (!open_between) continue;
        EXPECT_GT(gap_between(section[l].points_mm, section[m].points_mm), 0.2);
      }
    }
  }
}

TEST(Unite, HolesNarrowerThanASlitVanishWithTheirIslands) {
  const Polygon plate = box(0, 0, 60, 60);
  EXPECT_EQ(united({plate, reversed(box(10, 10, 50, 10.2))}).size(), 1U);
  EXPECT_EQ(united({plate, reversed(box(10, 10, 50, 10.4))}).size(), 2U);
  const auto with_pin = [&](double radius_mm) {
    return united({plate, reversed(circle({30, 30}, 10, 100)), circle({30, 30}, radius_mm, 90)});
  };
  EXPECT_EQ(with_pin(9.8).size(), 1U);
  EXPECT_NEAR(area_of(with_pin(9.8)), 3600, 1e-6);
  EXPECT_EQ(with_pin(9.5).size(), 3U);
}

TEST(Unite, PartsFurtherApartKeepTheirCurves) {
  std::vector<Polygon> discs;
  std::size_t points = 0;
  double area = 0;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      discs.push_back(circle({3.0 * i, 3.0 * j}, 1.3, 20 + i + j));
      points += discs.back().size();
      area += signed_area(discs.back());
    }
  }
  const CrossSection section = united(discs);
  EXPECT_EQ(section.size(), discs.size());
  EXPECT_EQ(points_of(section), points);
  EXPECT_NEAR(area_of(section), area, 1e-3);
}

/// The least of three measurements of the processor time of a union, s.
double seconds_for(const std::vector<Polygon>& polygons) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const std::clock_t start = std::clock();
    EXPECT_FALSE(united(polygons).empty());
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

TEST(Unite, TenTimesThePointsTakeFarLessThanAHundredTimesAsLong) {
  const auto with_points = [](int n) {
    const Polygon one = circle({0, 0}, 40, n);
    return std::vector<std::vector<Polygon>>{
        {one},                                                            // alone
        {one, one},                                                       // given twice
        {one, circle({0, 0}, 40, n, 1e-5)},                               // nearly given twice
        {one, circle({100, 0}, 40, n)},                                   // disjoint
        {one, reversed(circle({0, 0}, 30, n)), circle({0, 0}, 29.9, n)},  // with a slit
    };
  };
  const auto few = with_points(800), many = with_points(8000);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_LT(seconds_for(many[i]), 40 * seconds_for(few[i])) << i;
  }
}

TEST(Unite, CurvesWithoutAreaAreDropped) {
  EXPECT_TRUE(united({}).empty());
  EXPECT_TRUE(united({{}}).empty());
  EXPECT_TRUE(united({{{1, 1}}}).empty());
  EXPECT_TRUE(united({{{1, 1}, {5, 5}}}).empty());
  EXPECT_TRUE(united({{{1, 1}, {5, 5}, {9, 9}, {3, 3}}}).empty());
  EXPECT_TRUE(united({box(0, 0, 0.03, 0.03)}).empty());
}

TEST(CommonArea, OfTanglesAgreesWithSamples) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(0, 40);
  for (int i = 0; i < 20; ++i) {
    const std::vector<Polygon> a = tangle(random, i % 2 == 0), b = tangle(random, i % 3 == 0);
    constexpr int kSamples = 20000;
    int hits = 0;
    for (int s = 0; s < kSamples; ++s) {
      const Vector2d p(place(random), place(random));
      hits += winding(a, p) % 2 != 0 && winding(b, p) % 2 != 0;
    }
    const double sigma = 1600 * std::sqrt(0.25 / kSamples);
    EXPECT_NEAR(common_area(a, b), 1600.0 * hits / kSamples, 4 * sigma);
    EXPECT_NEAR(common_area(a, b), common_area(b, a), 1e-6);
  }
}

TEST(CommonArea, OfASmallRegionInALargeOneDoesNotDependOnTheRest) {
  const Polygon hole = circle({1, 2}, 3, 50);
  Polygon comb = {{-500, 900}, {-500, -900}};
  for (int i = 0; i < 400; ++i) comb.emplace_back(600 + i % 2, -900 + 4 * i);
  comb.emplace_back(600, 900);
  EXPECT_NEAR(common_area({hole}, {comb}), signed_area(hole), 1e-6);
  EXPECT_NEAR(common_area({hole}, {comb, box(1, -20, 900, 40)}), 0.5 * signed_area(hole), 1e-6);
  EXPECT_EQ(common_area({hole}, {box(5, 5, 9, 9)}), 0);
  // Both leave the box in which they could overlap, on the same side.
  EXPECT_NEAR(common_area({{{0, 0}, {4, 0}, {4, 9}, {3, 9}, {3, 1}, {0, 1}}},
                          {{{0, 0}, {2, 0}, {2, 7}, {-6, 7}, {-6, 6}, {0, 6}}}),
              2, 1e-9);
}

}  // namespace
}  // namespace hydroprint::waterline
