#include "sim/display/glb.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "sim/image/io/colour.h"
#include "sim/image/io/png.h"
#include "sim/mesh/read/read_model.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/value_of.h"

namespace hydroprint::display {
namespace {

/// Two triangles: one with a picture, one with the colours of its vertices times a factor.
DisplayModel two_parts() {
  DisplayModel out;
  out.origin_mm = {1000, -2000, 5};
  out.positions = {{0, 0, 0}, {10, 0, 0}, {0, 20, 0}, {0, 0, 5}, {10, 0, 5}, {0, 20, 5}};
  out.places = {0, 1, 2, 3, 4, 5};
  out.uvs = {{0, 0}, {1, 0}, {0, 0.25F}, {0, 0}, {0, 0}, {0, 0}};
  out.colours = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0.2F, 0.4F, 0.6F}};
  image::RgbImage image{2, 1, {255, 0, 0, 0, 0, 255}};
  out.pictures.push_back(
      {testing::value_of(image::encode_png(image, 96)), mesh::Wrap::kClamp, mesh::Wrap::kMirror});
  out.parts.push_back({"pictured", Eigen::Vector3f::Ones(), 0, {{0, 1, 2}}});
  out.parts.push_back({"b\xff\"n", {0.5F, 0.25F, 1}, -1, {{3, 4, 5}}});
  return out;
}

/// Reads bytes back with the reader of model files.
mesh::Model read_back(const std::string& glb) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("m.glb", glb);
  return testing::value_of(mesh::read_model(file, 1, {}));
}

TEST(Glb, IsReadBackAsItWas) {
  const DisplayModel model = two_parts();
  const mesh::Model read = read_back(testing::value_of(glb_of(model, "")));
  ASSERT_EQ(read.triangles.size(), 2U);
  ASSERT_EQ(read.corner_uvs.size(), 2U);
  for (int part = 0; part < 2; ++part) {
    for (int k = 0; k < 3; ++k) {
      const int corner = model.parts[part].triangles[0][k];
      const int vertex = read.triangles[part][k];
      const Eigen::Vector3d want = model.origin_mm + model.positions[corner].cast<double>();
      EXPECT_LT((read.vertices[vertex] - want).norm(), 1e-3);
      if (part == 0) {
        EXPECT_EQ(read.corner_uvs[part][k], model.uvs[corner]);
      }
      if (part == 1) {
        const Eigen::Vector3f colour = image::linear_from_srgb(read.vertex_colours[vertex]);
        EXPECT_LT((colour - model.colours[corner]).norm(), 1e-4F);
      }
    }
  }
  const mesh::Material &pictured = read.materials[read.triangle_material[0]],
                       &plain = read.materials[read.triangle_material[1]];
  EXPECT_EQ(pictured.texture_bytes, model.pictures[0].png);
  EXPECT_EQ(pictured.wrap_u, mesh::Wrap::kClamp);
  EXPECT_EQ(pictured.wrap_v, mesh::Wrap::kMirror);
  EXPECT_TRUE(plain.multiplies);
  EXPECT_TRUE(plain.uses_vertex_colours);
  EXPECT_LT((image::linear_from_srgb(plain.colour) - model.parts[1].colour).norm(), 1e-5F);
}

TEST(Glb, HasTheExtrasAndValidText) {
  const std::string glb = testing::value_of(glb_of(two_parts(), R"({"format": "OBJ"})"));
  std::uint32_t length = 0, text_length = 0;
  std::memcpy(&length, &glb[8], 4);
  std::memcpy(&text_length, &glb[12], 4);
  EXPECT_EQ(length, glb.size());
  EXPECT_EQ(text_length % 4, 0U);
  const auto json = nlohmann::json::parse(glb.substr(20, text_length));
  EXPECT_EQ(json.at("asset").at("extras").at("format"), "OBJ");
  EXPECT_EQ(json.at("materials").at(1).at("name"), "b\xEF\xBF\xBD\"n");
  const auto& positions = json.at("accessors")
                              .at(json.at("meshes")
                                      .at(0)
                                      .at("primitives")
                                      .at(0)
                                      .at("attributes")
                                      .at("POSITION")
                                      .get<int>());
  EXPECT_EQ(positions.at("min"), nlohmann::json({0, 0, 0}));
  EXPECT_EQ(positions.at("max"), nlohmann::json({10, 20, 5}));
  EXPECT_FALSE(glb_of(two_parts(), "{"));
}

}  // namespace
}  // namespace hydroprint::display
