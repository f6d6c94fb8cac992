#include "sim/image/figures/landed_ink.h"

#include <gtest/gtest.h>

#include "sim/base/pose.h"
#include "tests/sim/image/scenes.h"

namespace hydroprint::image {
namespace {

using namespace testing;

/// Colours on an upright plate of 20 x 1 mm, seen from the front, after films of two colours have
/// landed on parts of it.
class LandedInkTest : public ::testing::Test {
 protected:
  /// Film of one colour on the part of the plate where `lands`.
  [[nodiscard]] LandedInk film(std::array<int, 3> colour,
                               const std::function<bool(double x_mm)>& lands) const {
    std::vector<flow::MappedTriangle> tiles;
    for (const auto& tile : identity_tiles(surface_)) {
      const Eigen::Vector3i& t = surface_.triangles[static_cast<std::size_t>(tile.triangle)];
      const double x_mm =
          (surface_.points[t[0]] + surface_.points[t[1]] + surface_.points[t[2]]).x() / 3;
      if (lands(x_mm)) tiles.push_back(tile);
    }
    const auto outline = rectangle(40, 40);
    const auto texture = FilmTexture::from_image(
        make_image(40, 40, [&](int, int) { return colour; }), outline, 100, {});
    const auto views = find_views(surface_, pose_, tiles, {});
    EXPECT_TRUE(views && texture);
    return landed_ink(*views, *texture, {}).value();
  }

  /// The colour of the front view above a place on the plate.
  [[nodiscard]] std::array<int, 3> colour_at(const LandedInk& ink, double x_mm) const {
    const auto views = find_views(surface_, pose_, {}, {});
    const auto picture = ink_picture(*views, ink, {});
    EXPECT_TRUE(picture);
    const double px_per_mm = views->seen[0].samples_per_mm() / 2;
    const int x = static_cast<int>(kMargin_px + 0.5 * views->width_px + x_mm * px_per_mm);
    const int y = static_cast<int>(kMargin_px + 0.5 * views->height_px);
    return {picture->at(x, y)[0], picture->at(x, y)[1], picture->at(x, y)[2]};
  }

  mesh::Surface surface_ = surface_of(plate(-10, -0.5, 10, 0.5, 10, 1));
  /// Turned by a quarter about x: the plate's y becomes z.
  Pose pose_ = Pose(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX()));
};

TEST_F(LandedInkTest, InksOfTwoFilmsAddUpAndBareStaysGrey) {
  // Cyan on the left, magenta in the middle and on the left, nothing on the right.
  LandedInk ink;
  add_ink(film({0, 255, 255}, [](double x) { return x < -4; }), ink);
  add_ink(film({255, 0, 255}, [](double x) { return x < 4; }), ink);
  const auto both = colour_at(ink, -7), magenta = colour_at(ink, 0), bare = colour_at(ink, 7);
  EXPECT_EQ(both[0], 0);
  EXPECT_EQ(both[1], 0);
  EXPECT_GT(both[2], 150) << "cyan and magenta together are blue";
  EXPECT_GT(magenta[0], 150);
  EXPECT_EQ(magenta[1], 0);
  EXPECT_GT(magenta[2], 150);
  EXPECT_NEAR(bare[0], bare[1], 3);
  EXPECT_GT(bare[0], 100);
}

TEST_F(LandedInkTest, TwoHalfFilmsMakeTheFullColourAndMoreInkThanFullIsFull) {
  const auto everywhere = [](double) { return true; };
  LandedInk halves, full, twice;
  add_ink(film({127, 255, 255}, everywhere), halves);
  add_ink(film({128, 255, 255}, everywhere), halves);
  add_ink(film({0, 255, 255}, everywhere), full);
  twice = full;
  add_ink(full, twice);
  EXPECT_EQ(colour_at(halves, 0), colour_at(full, 0));
  EXPECT_EQ(colour_at(twice, 0), colour_at(full, 0));
}

}  // namespace
}  // namespace hydroprint::image
