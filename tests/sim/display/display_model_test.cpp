#include "sim/display/display_model.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/image/io/colour.h"
#include "tests/sim/support/bodies.h"
#include "tests/support/value_of.h"

namespace hydroprint::display {
namespace {

DisplayModel display_of(const mesh::Model& model) {
  const image::Paint paint = testing::value_of(image::load_paint(model, std::nullopt, {}));
  return testing::value_of(make_display(model, paint, {}));
}

mesh::Material coloured(const Eigen::Vector3f& srgb) {
  mesh::Material out;
  out.colour = srgb;
  out.has_colour = true;
  return out;
}

TEST(DisplayModel, HasAPartForEachMaterialInUse) {
  mesh::Model model = testing::box({0, 0, 0}, {10, 10, 10});
  model.materials = {coloured({1, 0, 0}), coloured({0, 1, 0}), coloured({0.5F, 0.5F, 0.5F})};
  model.materials[2].name = "grey";
  for (std::size_t t = 0; t < model.triangles.size(); ++t)
    model.triangle_material.push_back(t < 3 ? 2 : 0);
  const DisplayModel out = display_of(model);
  ASSERT_EQ(out.parts.size(), 2U) << "the green material is not used";
  EXPECT_EQ(out.parts[0].triangles.size(), 9U);
  EXPECT_EQ(out.parts[1].triangles.size(), 3U);
  EXPECT_EQ(out.parts[1].name, "grey");
  EXPECT_LT(
      (out.parts[1].colour - image::linear_from_srgb(Eigen::Vector3f(0.5F, 0.5F, 0.5F))).norm(),
      1e-6F);
  EXPECT_EQ(out.triangles(), model.triangles.size());
  EXPECT_TRUE(out.colours.empty());
  EXPECT_TRUE(out.uvs.empty());
}

TEST(DisplayModel, ColoursOfTrianglesAreNotMixedAtTheirCorners) {
  mesh::Model model = testing::box({0, 0, 0}, {10, 10, 10});
  for (std::size_t t = 0; t < model.triangles.size(); ++t)
    model.triangle_colours.emplace_back(t % 2 == 0 ? Eigen::Vector3f(1, 0, 0)
                                                   : Eigen::Vector3f(0, 0, 1));
  const DisplayModel out = display_of(model);
  ASSERT_EQ(out.parts.size(), 1U);
  ASSERT_EQ(out.colours.size(), out.positions.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (const int corner : out.parts[0].triangles[t])
      EXPECT_EQ(out.colours[corner], model.triangle_colours[t]);
  }
}

TEST(DisplayModel, CornersOfFacetsAreShared) {
  const mesh::Model solid = testing::torus(30, 10, 20, 10);
  mesh::Model facets;  // as in an STL file
  for (const auto& t : solid.triangles) {
    const int first = static_cast<int>(facets.vertices.size());
    for (const int corner : t) facets.vertices.push_back(solid.vertices[corner]);
    facets.triangles.emplace_back(first, first + 1, first + 2);
  }
  EXPECT_EQ(display_of(facets).positions.size(), 200U);
}

TEST(DisplayModel, FarFromTheOriginKeepsItsPrecision) {
  const Eigen::Vector3d far(4e8, -5e9, 1e6);
  const mesh::Model model = testing::moved(testing::torus(30, 10, 20, 10), far);
  const DisplayModel out = display_of(model);
  ASSERT_EQ(out.parts.size(), 1U);
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d at =
          out.origin_mm + out.positions[out.parts[0].triangles[t][k]].cast<double>();
      EXPECT_LT((at - model.vertices[model.triangles[t][k]]).norm(), 1e-5);
    }
  }
}

/// Two materials on a seam with different texture coordinates on its sides.
mesh::Model patchwork(mesh::Model model) {
  model.materials = {coloured({1, 0, 0}), coloured({0, 1, 0})};
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const bool is_left = model.vertices[model.triangles[t][0]].x() < 3;
    model.triangle_material.push_back(is_left ? 0 : 1);
    const float u = is_left ? 0.1F : 0.7F;
    model.corner_uvs.push_back(
        {Eigen::Vector2f(u, 0), Eigen::Vector2f(u, 1), Eigen::Vector2f(0, u)});
  }
  return model;
}

TEST(DisplayModel, PlacesAreThoseOfItsShapeWithoutColours) {
  for (const mesh::Model& plain :
       {testing::torus(30, 10, 40, 20), testing::torus(30, 10, 700, 200)}) {
    const mesh::Model model = patchwork(plain);
    const DisplayModel shown = display_of(model);
    const mesh::Model shape = testing::value_of(shown_shape(model, {}));
    EXPECT_GT(shown.positions.size(), shape.vertices.size()) << "seams have several vertices";
    ASSERT_EQ(shown.places.size(), shown.positions.size());
    std::vector<bool> is_used(shape.vertices.size(), false);
    for (std::size_t i = 0; i < shown.places.size(); ++i) {
      ASSERT_LT(static_cast<std::size_t>(shown.places[i]), shape.vertices.size());
      is_used[shown.places[i]] = true;
      EXPECT_EQ(shown.positions[i].cast<double>(), shape.vertices[shown.places[i]]);
    }
    EXPECT_EQ(std::ranges::count(is_used, false), 0);
  }
}

TEST(DisplayModel, OfAVeryFineMeshIsThinned) {
  const mesh::Model model = testing::torus(30, 10, 700, 200);
  const DisplayModel out = display_of(model);
  EXPECT_LE(out.triangles(), kMostTriangles);
  EXPECT_GT(out.triangles(), kMostTriangles / 3);
  EXPECT_TRUE(out.warnings.empty());
}

}  // namespace
}  // namespace hydroprint::display
