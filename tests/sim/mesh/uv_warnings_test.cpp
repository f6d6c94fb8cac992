#include "sim/mesh/uv_warnings.h"

#include <gtest/gtest.h>

namespace hydroprint::mesh {
namespace {

/// A square of the texture, as two triangles; `mirrored` swaps left and right on the object.
void add_square(Model& model, float low, float high, bool mirrored, int material = 0) {
  std::array<Eigen::Vector2f, 4> p = {{{low, low}, {high, low}, {high, high}, {low, high}}};
  if (mirrored) std::swap(p[1], p[3]);
  model.corner_uvs.push_back({p[0], p[1], p[2]});
  model.corner_uvs.push_back({p[0], p[2], p[3]});
  model.triangle_material.insert(model.triangle_material.end(), 2, material);
  model.materials.resize(std::max<std::size_t>(model.materials.size(), material + 1));
}

std::string codes(const Model& model) {
  std::string all;
  for (const auto& w : uv_warnings(model))
    all += std::string(name_of(w.code)) + " " + w.message.substr(0, 4) + ";";
  return all;
}

TEST(UvWarnings, ChartsSideBySideAreFine) {
  Model model;
  EXPECT_EQ(codes(model), "");
  add_square(model, 0, 0.5F, false);
  add_square(model, 0.5F, 1, false);
  EXPECT_EQ(codes(model), "");
}

TEST(UvWarnings, TextureUsedTwiceIsReportedWithItsShare) {
  Model model;
  add_square(model, 0, 1, false);
  add_square(model, 0, 0.5F, false);
  EXPECT_EQ(codes(model), "UV_OVERLAPPING 25 %;");
}

TEST(UvWarnings, RepetitionCountsAsOverlap) {
  Model model;
  add_square(model, 0, 0.5F, false);
  add_square(model, 1, 1.5F, false);
  EXPECT_EQ(codes(model), "UV_OVERLAPPING 100 ;");
}

TEST(UvWarnings, TexturesOfDifferentMaterialsDoNotOverlap) {
  Model model;
  add_square(model, 0, 1, false, 0);
  add_square(model, 0, 1, false, 1);
  EXPECT_EQ(codes(model), "");
}

TEST(UvWarnings, MirroredChartsAreReportedWithTheirShare) {
  Model model;
  add_square(model, 0, 0.4F, false);
  add_square(model, 0.5F, 0.9F, true);
  EXPECT_EQ(codes(model), "UV_MIRRORED 50 %;");
}

}  // namespace
}  // namespace hydroprint::mesh
