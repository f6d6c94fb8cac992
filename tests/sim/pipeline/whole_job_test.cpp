// Simulates every sample, and the real models if they are present, and lands the film image on them
// again. The landed colours must match the texture.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim/image/film/film_texture.h"
#include "sim/image/film/landed.h"
#include "sim/image/io/image_file.h"
#include "sim/mesh/read/read_model.h"
#include "sim/pipeline/simulate.h"
#include "sim/sample/sample.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::pipeline {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2f;
using Eigen::Vector3f;

struct Body {
  std::string name;
  fs::path mesh;  ///< empty: the sample named `name`
  double scale = 1;
  double turn_x_rad = 0;
  double least_coverage = 0;
  double least_right = 0.97;  ///< least share of points with the correct colour
};

void PrintTo(const Body& body, std::ostream* out) { *out << body.name; }

Vector3f wanted(const Vector2f& uv) { return {uv.x(), uv.y(), 0.4F}; }

/// A texture whose colour encodes the position: red grows with u, green with v.
fs::path write_gradient(const fs::path& folder) {
  constexpr int kSide = 256;
  image::RgbImage gradient{kSide, kSide, std::vector<std::uint8_t>(3 * kSide * kSide)};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Vector3f colour = wanted(
          {(static_cast<float>(x) + 0.5F) / kSide, 1 - (static_cast<float>(y) + 0.5F) / kSide});
      for (int c = 0; c < 3; ++c) {
        gradient.at(x, y)[c] = static_cast<std::uint8_t>(std::lround(255 * colour[c]));
      }
    }
  }
  EXPECT_TRUE(image::write_png(folder / "gradient.png", gradient, 72));
  return folder / "gradient.png";
}

/// The texture coordinate of each point of the surface; nullopt at seams, where a point has
/// several.
std::vector<std::optional<Vector2f>> point_uvs(const mesh::Model& model,
                                               const mesh::Surface& surface) {
  std::vector<std::optional<Vector2f>> uvs(surface.points.size());
  std::vector<char> is_seam(surface.points.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& corners = model.corner_uvs[surface.source_triangle[t]];
    for (int i = 0; i < 3; ++i) {
      const int v = surface.weld[surface.triangles[t][i]];
      const Vector3f& b = surface.source_barycentric[t][i];
      const Vector2f uv = b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2];
      if (uvs[v] && (*uvs[v] - uv).norm() > 1e-4F) is_seam[v] = 1;
      uvs[v] = uv;
    }
  }
  for (std::size_t v = 0; v < uvs.size(); ++v) {
    const bool is_outside = uvs[v] && (uvs[v]->minCoeff() < 0.01F || uvs[v]->maxCoeff() > 0.99F);
    if (is_seam[v] != 0 || is_outside) uvs[v].reset();
  }
  return uvs;
}

class WholeJobOf : public ::testing::TestWithParam<Body> {};

TEST_P(WholeJobOf, EachColourLandsWhereTheTextureHasIt) {
  const Body& body = GetParam();
  if (!body.mesh.empty() && !fs::exists(body.mesh)) GTEST_SKIP() << body.mesh << " does not exist";
  const testing::TemporaryFolder folder;
  SimulateOptions options;
  options.mesh = body.mesh;
  if (body.mesh.empty()) {
    ASSERT_TRUE(sample::write_sample(body.name, folder.path()));
    options.mesh = folder.path() / (body.name + ".obj");
  }
  options.scale = body.scale;
  options.texture = write_gradient(folder.path());
  options.dpi = 150;
  options.dip.outline = film::parse_outline("A4").value();
  Context context;
  context.threads = 2;
  const mesh::Model model = mesh::read_model(options.mesh, body.scale, context).value();
  Pose X_FO(Eigen::AngleAxisd(body.turn_x_rad, Eigen::Vector3d::UnitX()));
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : model.vertices) box.extend(X_FO * p);
  X_FO.pretranslate(-box.center());
  options.dip.X_FO = X_FO;

  const auto simulation = simulate(options, context);
  ASSERT_TRUE(simulation) << simulation.error().message;
  EXPECT_GE(simulation->dip.figures.coverage, body.least_coverage);
  ASSERT_TRUE(simulation->images);
  EXPECT_EQ(simulation->images->film.width, 1240);
  EXPECT_EQ(simulation->images->film.height, 1754);

  const auto film =
      image::FilmTexture::from_image(simulation->images->film, options.dip.outline, 4096, context);
  ASSERT_TRUE(film);
  const flow::SurfaceMap& map = simulation->dip.map.surface;
  const auto landed = image::landed_colours(map, *film);
  const auto uvs = point_uvs(simulation->model, simulation->dip.surface);
  int compared = 0, right = 0;
  for (std::size_t v = 0; v < uvs.size(); ++v) {
    // Where film is stretched to several times its length, a film pixel covers too large an area to
    // be compared.
    const bool is_telling = map.stretch[v] < 3 && map.least_stretch[v] > 0.3;
    if (!uvs[v] || !is_telling || !landed[v].allFinite()) continue;
    ++compared;
    right += (landed[v] - wanted(*uvs[v])).cwiseAbs().maxCoeff() < 10.0F / 255;
  }
  EXPECT_GT(compared, 20);
  EXPECT_GT(right, body.least_right * compared) << "of " << compared << " points";
}

const fs::path kModels = testing::model_path("");
constexpr double kUpright = std::numbers::pi / 2;

std::string name_of(const ::testing::TestParamInfo<Body>& body) { return body.param.name; }

// tests/run simulates these three, tests/campaign the others.
INSTANTIATE_TEST_SUITE_P(
    Few, WholeJobOf,
    ::testing::Values(
        Body{"board", {}, 1, 0, 0.4},
        Body{"spot_quads", kModels / "spot/spot_quadrangulated.obj", 25, 0, 0.97},
        // Air is trapped under its foot. Points at the edge of that lie beside white film.
        Body{"mug_scan", kModels / "mug/mug.obj", 6, kUpright, 0.4, 0.95}),
    name_of);
INSTANTIATE_TEST_SUITE_P(Samples, WholeJobOf,
                         ::testing::Values(Body{"globe", {}, 1, 0, 0.99},
                                           Body{"sphere80", {}, 1, 0, 0.99},
                                           Body{"ubend", {}, 1, 0, 0.6},
                                           Body{"mug", {}, 1, 0, 0.4}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(
    Models, WholeJobOf,
    ::testing::Values(Body{"spot", kModels / "spot/spot_triangulated.obj", 30, kUpright, 0.97},
                      Body{"bunny", kModels / "bunny/bunny_with_uv.obj", 300, kUpright, 0.8},
                      Body{"head", kModels / "head/LeePerrySmith_converted.obj", 7, kUpright, 0.6},
                      // three open shells that meet in rings; film there may land on either shell
                      Body{"bottle", kModels / "bottle/WaterBottle.gltf", 400, kUpright, 0.6,
                           0.94}),
    name_of);

TEST(WholeJob, AModelWithoutColourIsRefusedUnlessItsFilmMayBeBlank) {
  const fs::path cat = kModels / "cat/cat-low-resolution.obj";
  if (!fs::exists(cat)) GTEST_SKIP() << cat << " does not exist";
  SimulateOptions options;
  options.mesh = cat;
  options.scale = 10;
  options.dpi = 50;
  options.dip.outline = film::parse_outline("A4").value();
  options.dip.depth_mm = 5;
  const auto refused = simulate(options, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::kInvalidArgument);
  EXPECT_EQ(refused.error().message.find(cat.string()), 0U) << refused.error().message;
  EXPECT_NE(refused.error().message.find("no colour"), std::string::npos);
  options.needs_colour = false;
  const auto simulation = simulate(options, {});
  ASSERT_TRUE(simulation) << simulation.error().message;
  for (const std::uint8_t value : simulation->images->film.rgb) ASSERT_EQ(value, 255);
}

}  // namespace
}  // namespace hydroprint::pipeline
