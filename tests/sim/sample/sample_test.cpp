#include "sim/sample/sample.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "sim/mesh/make_surface.h"
#include "sim/mesh/read/read_model.h"
#include "sim/mesh/uv_warnings.h"
#include "tests/support/content.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::sample {
namespace {

using testing::content;

/// The files written by write_sample().
struct Written {
  hydroprint::testing::TemporaryFolder folder;
  mesh::Model model;  ///< as read back
};

/// Each kind is written and read once for all tests of this program.
const Written& written(const std::string& kind) {
  static std::map<std::string, Written> all;
  const auto [place, is_new] = all.try_emplace(kind);
  if (is_new) {
    const auto status = write_sample(kind, place->second.folder.path());
    EXPECT_TRUE(status) << status.error().message;
    auto model = mesh::read_model(place->second.folder.path() / (kind + ".obj"), 1, {});
    EXPECT_TRUE(model) << model.error().message;
    if (model) place->second.model = *std::move(model);
  }
  return place->second;
}

class EverySample : public ::testing::TestWithParam<std::string> {
 protected:
  const mesh::Model& model = written(GetParam()).model;
  const std::filesystem::path folder = written(GetParam()).folder.path();
};

TEST_P(EverySample, IsAClosedManifoldFacingOutward) {
  EXPECT_TRUE(model.warnings.empty());
  const auto surface = mesh::make_surface(model, mesh::kMaxEdgeMm, {});
  ASSERT_TRUE(surface);
  EXPECT_TRUE(surface->closed);
  EXPECT_TRUE(surface->warnings.empty()) << surface->warnings.front().message;
}

TEST_P(EverySample, HasTextureCoordinatesInTheUnitSquareThatAreNotMirrored) {
  ASSERT_EQ(model.corner_uvs.size(), model.triangles.size());
  for (const auto& uvs : model.corner_uvs) {
    for (const auto& uv : uvs) {
      EXPECT_GE(uv.minCoeff(), 0);
      EXPECT_LE(uv.maxCoeff(), 1);
    }
    const Eigen::Vector2f a = uvs[1] - uvs[0];
    const Eigen::Vector2f b = uvs[2] - uvs[0];
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0);
  }
  EXPECT_TRUE(mesh::uv_warnings(model).empty());
}

TEST_P(EverySample, NamesItsOwnTexture) {
  ASSERT_EQ(model.materials.size(), 1U);
  EXPECT_EQ(model.materials[0].texture, folder / (GetParam() + ".png"));
  EXPECT_GT(std::filesystem::file_size(model.materials[0].texture), 10000U);
}

TEST_P(EverySample, FitsOnA4AndStandsOnItsFeet) {
  Eigen::AlignedBox3d box;
  for (const auto& v : model.vertices) box.extend(v);
  EXPECT_LT(box.sizes().x(), 190);
  EXPECT_LT(box.sizes().y(), 190);
  EXPECT_GT(box.sizes().maxCoeff(), 50);
}

TEST_P(EverySample, IsByteIdenticalEveryTime) {
  const auto again = folder / "again" / "deeper";
  ASSERT_TRUE(write_sample(GetParam(), again));
  for (const std::string ending : {".obj", ".mtl", ".png"})
    EXPECT_EQ(content(folder / (GetParam() + ending)), content(again / (GetParam() + ending)));
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const auto& kind : kinds()) result.push_back(kind.name);
  return result;
}

INSTANTIATE_TEST_SUITE_P(All, EverySample, ::testing::ValuesIn(names()),
                         [](const auto& test) { return test.param; });

TEST(Sample, SizesMatchThePaper) {
  EXPECT_EQ(names(),
            (std::vector<std::string>{"globe", "sphere80", "board", "ubend", "mug", "bowl"}));
  const mesh::Model& globe = written("globe").model;
  EXPECT_GE(globe.triangles.size(), 80000U);
  for (const auto& v : globe.vertices) EXPECT_NEAR(v.norm(), 60, 1e-5);
  for (const auto& v : written("sphere80").model.vertices) EXPECT_NEAR(v.norm(), 80, 1e-5);
  Eigen::AlignedBox3d box;
  for (const auto& v : written("board").model.vertices) box.extend(v);
  EXPECT_LT((box.sizes() - Eigen::Vector3d(120, 120, 10)).norm(), 1e-5);
}

TEST(Sample, TheGlobesMapRunsEastFromTheAntimeridian) {
  const mesh::Model& globe = written("globe").model;
  for (std::size_t t = 0; t < globe.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto& p = globe.vertices[globe.triangles[t][k]];
      const auto& uv = globe.corner_uvs[t][k];
      EXPECT_NEAR(p.z(), 60 * std::sin(M_PI * (uv.y() - 0.5)), 1e-4);
      const double across = std::hypot(p.x(), p.y());
      EXPECT_NEAR(p.x(), across * std::cos(2 * M_PI * (uv.x() - 0.5)), 1e-4);
      EXPECT_NEAR(p.y(), across * std::sin(2 * M_PI * (uv.x() - 0.5)), 1e-4);
    }
}

TEST(Sample, TheBoardsLinesCrossAtVertices) {
  const auto board = make_model("board");
  ASSERT_TRUE(board);
  std::set<std::tuple<int, int, int>> places;
  for (const auto& v : board->vertices) {
    const Eigen::Vector3d tens = v / 10;
    EXPECT_LT((tens - tens.array().round().matrix()).norm(), 1e-12);
    places.insert({static_cast<int>(std::lround(tens.x())), static_cast<int>(std::lround(tens.y())),
                   static_cast<int>(std::lround(tens.z()))});
  }
  EXPECT_EQ(places.size(), 2U * 13 * 13);
}

TEST(Sample, IsTheSameInMemoryAsInItsFiles) {
  for (const std::string kind : {"board", "bowl"}) {
    const mesh::Model& read = written(kind).model;
    const auto made = make_model(kind);
    ASSERT_TRUE(made);
    ASSERT_EQ(made->vertices.size(), read.vertices.size()) << kind;
    for (std::size_t v = 0; v < read.vertices.size(); ++v) {
      ASSERT_LT((made->vertices[v] - read.vertices[v]).norm(), 1e-5) << kind;
    }
    ASSERT_EQ(made->triangles, read.triangles) << kind;
    ASSERT_EQ(made->corner_uvs.size(), read.corner_uvs.size());
    for (std::size_t t = 0; t < read.corner_uvs.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        ASSERT_LT((made->corner_uvs[t][k] - read.corner_uvs[t][k]).norm(), 1e-6F) << kind;
      }
    }
    const std::string png = content(written(kind).folder.path() / (kind + ".png"));
    EXPECT_EQ(std::string(made->materials[0].texture_bytes.begin(),
                          made->materials[0].texture_bytes.end()),
              png);
  }
  EXPECT_FALSE(make_model("teapot"));
}

TEST(Sample, UnknownKindsAreRefusedWithTheKnownOnes) {
  const auto refused = write_sample("teapot", "/tmp");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::kInvalidArgument);
  EXPECT_NE(refused.error().message.find("globe, sphere80, board, ubend, mug, bowl"),
            std::string::npos);
}

TEST(Sample, FoldersThatCannotBeCreatedAreRefused) {
  EXPECT_FALSE(write_sample("board", "/dev/null/folder"));
}

}  // namespace
}  // namespace hydroprint::sample
