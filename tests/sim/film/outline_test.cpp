#include "sim/film/outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/temporary_folder.h"

namespace hydroprint::film {
namespace {

using Eigen::Vector2d;

double area_mm2(const Outline& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.polygon.size(); ++i) {
    const Vector2d& a = outline.polygon[i];
    const Vector2d& b = outline.polygon[(i + 1) % outline.polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

Result<Outline> polygon(const std::string& json) {
  const testing::TemporaryFolder folder;
  return parse_outline("polygon:" + folder.write("film.json", json).string());
}

TEST(Outline, NamedSheetsArePortraitAndCentred) {
  const std::vector<std::pair<std::string, Vector2d>> sheets = {{"A4", {210, 297}},
                                                                {"A3", {297, 420}},
                                                                {"letter", {215.9, 279.4}},
                                                                {"Letter", {215.9, 279.4}}};
  for (const auto& [name, size_mm] : sheets) {
    const auto outline = parse_outline(name);
    ASSERT_TRUE(outline) << outline.error().message;
    EXPECT_EQ(outline->size_mm(), size_mm) << name;
    EXPECT_EQ(outline->max_mm, size_mm / 2) << name;
    EXPECT_EQ(outline->name, name);
    EXPECT_NEAR(area_mm2(*outline), size_mm.prod(), 1e-9)
        << "the outline must be a counter-clockwise rectangle";
  }
}

TEST(Outline, WidthComesBeforeHeight) {
  const auto outline = parse_outline("120.5x80");
  ASSERT_TRUE(outline);
  EXPECT_EQ(outline->size_mm(), Vector2d(120.5, 80));
}

TEST(Outline, CircleHasTheCirclesAreaShortChordsAndBothMirrorSymmetries) {
  for (const double radius_mm : {5.0, 105.0, 1000.0}) {
    const auto outline = parse_outline("circle:" + std::to_string(radius_mm));
    ASSERT_TRUE(outline) << outline.error().message;
    const double area = std::numbers::pi * radius_mm * radius_mm;
    EXPECT_NEAR(area_mm2(*outline), area, 1e-9 * area);
    EXPECT_EQ(outline->size_mm(), Vector2d(2 * radius_mm, 2 * radius_mm));
    const auto& corners = outline->polygon;
    ASSERT_EQ(corners.size() % 4, 0u);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      EXPECT_LE((corners[i] - corners[(i + 1) % corners.size()]).norm(), 3 + 1e-9);
      const Vector2d& mirrored = corners[(corners.size() - i) % corners.size()];
      EXPECT_NEAR((mirrored - Vector2d(corners[i].x(), -corners[i].y())).norm(), 0, 1e-9);
    }
  }
}

TEST(Outline, PolygonStaysWhereTheFilePutsItAndTurnsCounterClockwise) {
  const auto outline = polygon("[[10, 20], [10, 60], [50, 60], [50, 20], [10, 20]]");
  ASSERT_TRUE(outline) << outline.error().message;
  EXPECT_EQ(outline->polygon.size(), 4u) << "a repeated last corner counts once";
  EXPECT_EQ(outline->min_mm, Vector2d(10, 20));
  EXPECT_EQ(outline->max_mm, Vector2d(50, 60));
  EXPECT_DOUBLE_EQ(area_mm2(*outline), 1600);
}

TEST(Outline, PolygonsThatCrossOrTouchThemselvesAreRefusedByCorner) {
  const std::vector<std::string> bad = {
      "[[0,0],[40,40],[40,0],[0,40]]",                  // crosses itself
      "[[0,0],[40,0],[20,0],[20,40]]",                  // folds back
      "[[0,0],[40,0],[40,40],[20,0],[0,40]]",           // touches an edge with a corner
      "[[0,0],[20,20],[40,0],[40,40],[20,20],[0,40]]",  // touches itself at a corner
      "[[0,0],[40,0],[80,0]]",                          // no area
      "[[0,0],[40,0],[40,0],[0,40]]",                   // same corner twice
  };
  for (const std::string& json : bad) {
    const auto outline = polygon(json);
    ASSERT_FALSE(outline) << json;
    EXPECT_TRUE(outline.error().code == Code::kInvalidArgument ||
                outline.error().code == Code::kOutOfRange);
    EXPECT_EQ(outline.error().message.find('\n'), std::string::npos);
    EXPECT_NE(outline.error().message.find("film.json"), std::string::npos);
  }
}

TEST(Outline, PolygonFilesThatAreNotListsOfCornersAreRefused) {
  for (const std::string json :
       {"", "{}", "[", "[[1,2],[3]]", "[[1,2],[3,4]]", "[[1,2],[3,\"4\"],[5,6]]", "[1,2,3]",
        "[[0,0],[40,0],[1e999,40]]", "[[0,0],[40,0],[NaN,40]]"}) {
    const auto outline = polygon(json);
    ASSERT_FALSE(outline) << json;
    EXPECT_EQ(outline.error().code, Code::kInvalidArgument) << json;
  }
  EXPECT_EQ(parse_outline("polygon:/no/such/file.json").error().code, Code::kNotFound);
}

TEST(Outline, BrokenJsonIsNamedByLineAndColumn) {
  const auto outline = polygon("[[0,0],\n [40,],\n [0,40]]");
  ASSERT_FALSE(outline);
  EXPECT_NE(outline.error().message.find("line 2, column 6"), std::string::npos)
      << outline.error().message;
}

TEST(Outline, SizesOutOfRangeAreRefused) {
  for (const std::string text : {"9.9x100", "100x2001", "-100x100", "0x0", "nanx100", "infx100",
                                 "circle:4", "circle:1001", "circle:-50", "circle:nan"}) {
    const auto outline = parse_outline(text);
    ASSERT_FALSE(outline) << text;
    EXPECT_EQ(outline.error().code, Code::kOutOfRange) << text;
  }
  EXPECT_EQ(polygon("[[0,0],[5,0],[0,5]]").error().code, Code::kOutOfRange);
}

TEST(Outline, UnknownWordsAreRefused) {
  for (const std::string text : {"", "A5", "x", "210x", "x297", "210x297mm", "210 x 297",
                                 "circle:", "circle:5mm", "210x297x3"}) {
    const auto outline = parse_outline(text);
    ASSERT_FALSE(outline) << text;
    EXPECT_EQ(outline.error().code, Code::kInvalidArgument) << text;
  }
}

TEST(Outline, ContainsTheInsideAndTheEdgeOnly) {
  // A rectangle with a notch from above.
  const auto outline = polygon("[[0,0],[40,0],[40,40],[20,10],[0,40]]");
  ASSERT_TRUE(outline);
  for (const Vector2d& inside :
       {Vector2d(20, 5), Vector2d(1, 30), Vector2d(39, 30), Vector2d(20, 10), Vector2d(0, 20),
        Vector2d(0, 0), Vector2d(30, 25), Vector2d(10, 10)}) {
    EXPECT_TRUE(contains(*outline, inside)) << inside.transpose();
  }
  for (const Vector2d& outside : {Vector2d(20, 11), Vector2d(20, 40), Vector2d(-1, 10),
                                  Vector2d(-1, 0), Vector2d(41, 40), Vector2d(-5, 40)}) {
    EXPECT_FALSE(contains(*outline, outside)) << outside.transpose();
  }
}

}  // namespace
}  // namespace hydroprint::film
