// The verb predict: from a film image to the landed colours.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "sim/image/io/image_file.h"
#include "tests/sim/worker/artifact_files.h"
#include "tests/sim/worker/worker_fixture.h"

namespace hydroprint::worker {
namespace {

/// A film image of four colours, one per quarter.
image::RgbImage quarters(int width, int height) {
  image::RgbImage film{width, height, std::vector<std::uint8_t>(3 * width * height)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool right = 2 * x >= width;
      const bool above = 2 * y < height;
      std::uint8_t* pixel = film.at(x, y);
      pixel[0] = right ? 255 : 0;
      pixel[1] = above ? 0 : 255;
      pixel[2] = right ? 0 : 255;
    }
  }
  return film;
}

TEST_F(Worker, PredictedQuartersOfTheFilmLandOnTheirSideOfTheSphere) {
  ASSERT_TRUE(image::write_png(path("film.png"), quarters(240, 280), 100));
  const Ended ended = testing::run(predict({"--depth-mm", "12"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(names_in(out()),
            (std::set<std::string>{"landed.ply", "landed.png", "predicted.png", "report.json"}));
  int seen = 0;
  for (const auto& [xyz, colour] : read_landed(out() + "/landed.ply")) {
    if (xyz[2] > 0.01) {
      EXPECT_EQ(colour, (std::array<std::uint8_t, 4>{255, 255, 255, 0}))
          << "a point above the water must stay white and unreached";
      continue;
    }
    // Skips vertices near the borders of the quarters, where the film's motion shifts the colours.
    if (std::min(std::abs(xyz[0]), std::abs(xyz[1])) < 1.5 || xyz[2] > -0.5) continue;
    const std::array<std::uint8_t, 4> expected = {static_cast<std::uint8_t>(xyz[0] > 0 ? 255 : 0),
                                                  static_cast<std::uint8_t>(xyz[1] > 0 ? 0 : 255),
                                                  static_cast<std::uint8_t>(xyz[0] > 0 ? 0 : 255),
                                                  1};
    EXPECT_EQ(colour, expected) << xyz[0] << " " << xyz[1] << " " << xyz[2];
    ++seen;
  }
  EXPECT_GT(seen, 200);
}

TEST_F(Worker, PredictFollowsThePathAsDriven) {
  ASSERT_TRUE(image::write_png(path("film.png"), quarters(240, 280), 100));
  // The object drifts 4 mm to the right on its way down, so the film comes from farther right.
  folder.write("driven.csv", "t_s,x_mm,y_mm,z_mm\n0,0,0,50\n1,4,0,45\n2,4,0,38\n");
  ASSERT_EQ(testing::run(predict({"--depth-mm", "12", "--artifacts", "map"})).status, 0);
  const Ply straight = read_ply(out() + "/surface_map.ply");
  const Ended ended = testing::run(
      predict({"--depth-mm", "12", "--artifacts", "map", "--motion", path("driven.csv")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  const Ply driven = read_ply(out() + "/surface_map.ply");
  ASSERT_EQ(straight.vertices.size(), driven.vertices.size());
  double shift = 0;
  int count = 0;
  for (std::size_t i = 0; i < driven.vertices.size(); ++i) {
    const double x = driven.vertices[i][3] - straight.vertices[i][3];
    if (!std::isfinite(x) || driven.vertices[i][2] > -2) continue;
    shift += x;
    ++count;
  }
  ASSERT_GT(count, 100);
  EXPECT_GT(shift / count, 0.5);
  EXPECT_LT(shift / count, 4);
}

TEST_F(Worker, PredictRefusesBadFilmImagesAndPaths) {
  folder.write("film.png", "not an image");
  expect_refusal(3, predict({}), {"film.png: "});
  ASSERT_TRUE(image::write_png(path("film.png"), quarters(240, 280), 100));
  folder.write("driven.csv", "t_s,x_mm,y_mm,z_mm\n0,0,0,0\n0,0,0,-1\n");
  expect_refusal(3, predict({"--motion", path("driven.csv")}), {"driven.csv: line 3: "});
}

}  // namespace
}  // namespace hydroprint::worker
