#include <Eigen/Geometry>
#include <filesystem>

#include "sim/mesh/make_surface.h"
#include "tests/sim/mesh/files.h"
#include "tests/support/paths.h"

namespace hydroprint::mesh {
namespace {

struct Expected {
  const char* file;
  std::size_t vertices;
  std::size_t triangles;
  bool has_uvs;
  bool closed;
};

class RealModel : public ::testing::TestWithParam<Expected> {};

std::filesystem::path model_path(const std::string& name) { return testing::model_path(name); }

TEST_P(RealModel, IsReadAsItsReadmeDescribesIt) {
  const auto& expected = GetParam();
  const auto path = model_path(expected.file);
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " does not exist";
  const Model m = read(path, 10);
  EXPECT_EQ(m.vertices.size(), expected.vertices);
  EXPECT_EQ(m.triangles.size(), expected.triangles);
  EXPECT_EQ(!m.corner_uvs.empty(), expected.has_uvs);
  const auto surface = make_surface(m, kMaxEdgeMm, {});
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->closed, expected.closed);
  EXPECT_EQ(has_warning(surface->warnings, WarningCode::MESH_OPEN), !expected.closed);
  EXPECT_FALSE(has_warning(surface->warnings, WarningCode::INSIDE_OUT));
  EXPECT_FALSE(has_warning(surface->warnings, WarningCode::MESH_NON_MANIFOLD));
}

INSTANTIATE_TEST_SUITE_P(
    All, RealModel,
    ::testing::Values(Expected{"spot/spot_triangulated.obj", 2930, 5856, true, true},
                      Expected{"spot/spot_quadrangulated.obj", 2930, 5856, true, true},
                      Expected{"bunny/bunny_with_uv.obj", 2741, 4968, true, false},
                      Expected{"bunny/bunny_hr.obj", 29834, 59664, false, true},
                      Expected{"head/LeePerrySmith_converted.obj", 8838, 17672, true, true},
                      Expected{"mug/mug.obj", 12272, 24544, true, true},
                      Expected{"cat/cat-low-resolution.obj", 7949, 15894, false, true},
                      Expected{"bottle/WaterBottle.gltf", 2549, 4510, true, false},
                      Expected{"bottle/WaterBottle_converted.obj", 2385, 4510, true, false}));

TEST(RealModels, BottleAsGltfAndAsObjAgree) {
  const auto path = model_path("bottle/WaterBottle.gltf");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " does not exist";
  const Model gltf = read(path, 1000);
  const Model obj = read(model_path("bottle/WaterBottle_converted.obj"), 1000);
  ASSERT_EQ(gltf.triangles.size(), obj.triangles.size());
  for (std::size_t t = 0; t < obj.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT((gltf.vertices[gltf.triangles[t][k]] - obj.vertices[obj.triangles[t][k]]).norm(),
                1e-3);
      EXPECT_LT((gltf.corner_uvs[t][k] - obj.corner_uvs[t][k]).norm(), 1e-5);
    }
  EXPECT_EQ(gltf.materials.at(0).texture.filename(), obj.materials.at(0).texture.filename());
}

}  // namespace
}  // namespace hydroprint::mesh
