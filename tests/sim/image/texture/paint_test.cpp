#include "sim/image/texture/paint.h"

#include <gtest/gtest.h>

#include <random>

#include "sim/image/io/colour.h"
#include "tests/sim/image/scenes.h"

namespace hydroprint::image {
namespace {

using namespace testing;

bool has_warning(const Paint& paint, WarningCode code) {
  for (const auto& warning : paint.warnings()) {
    if (warning.code == code) return true;
  }
  return false;
}

RgbImage print(const mesh::Model& model, const Paint& paint, double width_mm, double height_mm,
               double dpi) {
  const mesh::Surface surface = surface_of(model);
  auto image =
      film_image(surface, identity_tiles(surface), paint, rectangle(width_mm, height_mm), dpi, {});
  EXPECT_TRUE(image) << (image ? "" : image.error().message);
  return std::move(*image);
}

Paint load(const mesh::Model& model, const RgbImage& texture) {
  const TemporaryFolder folder;
  EXPECT_TRUE(write_png(folder / "t.png", texture, 72));
  auto paint = load_paint(model, folder / "t.png", {});
  EXPECT_TRUE(paint) << (paint ? "" : paint.error().message);
  return std::move(*paint);
}

/// A texture that is red inside a triangle (texels whose centre lies inside) and blue elsewhere.
RgbImage red_triangle_on_blue(const Corners& uv, int size) {
  RgbImage image = make_image(size, size, [](int, int) { return kBlue; });
  Corners at;
  for (int i = 0; i < 3; ++i) at[i] = {uv[i].x() * size, (1 - uv[i].y()) * size};
  for_each_sample(at, {0, 0, size, size}, [&](int x, int y, const Eigen::Vector3d&) {
    for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<std::uint8_t>(kRed[c]);
  });
  return image;
}

TEST(Paint, ARedChartOnBlueShowsNoBlue) {
  // A chart with sharp corners, at an angle to the texels, from magnified to 30 times minified.
  const Corners uv = {Eigen::Vector2d(0.13, 0.17), Eigen::Vector2d(0.81, 0.23),
                      Eigen::Vector2d(0.66, 0.41)};
  mesh::Model model;
  model.path = "triangle.obj";
  model.vertices = {{-30, -20, 0}, {30, -20, 0}, {10, 20, 0}};
  model.triangles = {{0, 1, 2}};
  model.corner_uvs = {{uv[0].cast<float>(), uv[1].cast<float>(), uv[2].cast<float>()}};
  for (const int size : {32, 256, 2048}) {
    const Paint paint = load(model, red_triangle_on_blue(uv, size));
    for (const double dpi : {25.0, 60.0, 200.0}) {
      const RgbImage image = print(model, paint, 64, 44, dpi);
      int red = 0;
      for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        // Red may get paler towards the edge, but never darker or bluer.
        ASSERT_EQ(image.rgb[i], 255) << size << " texels, " << dpi << " dpi";
        ASSERT_EQ(image.rgb[i + 1], image.rgb[i + 2]);
        red += image.rgb[i + 1] == 0 ? 1 : 0;
      }
      EXPECT_GT(red, 100);
    }
  }
}

/// Two squares side by side in space and in the texture, but with a seam between them (their
/// common UV edge belongs to different places of the object).
mesh::Model two_charts_without_gutter() {
  mesh::Model model;
  model.path = "two.obj";
  const auto add = [&](double x0, float u0) {
    const int v = static_cast<int>(model.vertices.size());
    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      model.vertices.emplace_back(x0 + 20 * dx, -10 + 20 * dy, 0);
    }
    const auto uv = [&](float u, float w) { return Eigen::Vector2f(u0 + 0.5F * u, w); };
    model.triangles.emplace_back(v, v + 1, v + 2);
    model.corner_uvs.push_back({uv(0, 0), uv(1, 0), uv(1, 1)});
    model.triangles.emplace_back(v, v + 2, v + 3);
    model.corner_uvs.push_back({uv(0, 0), uv(1, 1), uv(0, 1)});
  };
  add(-25, 0);
  add(5, 0.5F);
  return model;
}

TEST(Paint, AdjacentChartsWithoutGutterDoNotMix) {
  const mesh::Model model = two_charts_without_gutter();
  for (const int size : {16, 64, 512, 1000}) {
    const Paint paint = load(
        model, make_image(size, size, [&](int x, int) { return x < size / 2 ? kRed : kBlue; }));
    for (const double dpi : {25.4, 50.8, 101.6}) {
      const RgbImage image = print(model, paint, 60, 30, dpi);
      for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
          const std::uint8_t* p = image.at(x, y);
          if (x < image.width / 2) {
            ASSERT_EQ(p[0], 255) << size << ", " << dpi << ": " << x << ", " << y;
          } else {
            ASSERT_EQ(p[2], 255) << size << ", " << dpi << ": " << x << ", " << y;
          }
          ASSERT_TRUE(p[1] == 255 || p[1] == 0 || (p[0] == 255 || p[2] == 255));
        }
      }
    }
  }
}

TEST(Paint, MirroredHalvesOnTheSameTexelsAreBothPainted) {
  mesh::Model model = plate(-20, -10, 0, 10);
  const mesh::Model half = plate(0, -10, 20, 10);
  for (std::size_t t = 0; t < 2; ++t) {
    model.triangles.push_back(half.triangles[t].array() + 4);
    auto uvs = half.corner_uvs[t];
    for (auto& uv : uvs) uv.x() = 1 - uv.x();
    model.corner_uvs.push_back(uvs);
  }
  model.vertices.insert(model.vertices.end(), half.vertices.begin(), half.vertices.end());
  const RgbImage image =
      print(model,
            load(model, make_image(64, 64,
                                   [](int x, int y) {
                                     return std::array<int, 3>{x * 4, y * 4, 128};
                                   })),
            40, 20, 100);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width / 2; ++x) {
      const std::uint8_t* left = image.at(x, y);
      const std::uint8_t* right = image.at(image.width - 1 - x, y);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(left[c], right[c], 2) << x << ", " << y;
    }
  }
}

TEST(Paint, WrapModesDefineTheTextureOutside) {
  // UVs from -1 to 2 in both directions over a texture that is dark on its left.
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "t.png",
                        make_image(60, 60, [](int x, int) { return x < 30 ? kBlack : kRed; }), 72));
  mesh::Model model = plate(-30, -30, 30, 30);
  for (auto& uvs : model.corner_uvs) {
    for (auto& uv : uvs) uv = uv * 3 - Eigen::Vector2f::Ones();
  }
  model.materials.resize(1);
  model.materials[0].name = "m";
  model.materials[0].texture = folder / "t.png";
  model.triangle_material = {0, 0};
  // Colours of the six half texture widths from left to right: "d" dark, "r" red.
  const auto dark = [&](mesh::Wrap wrap) {
    model.materials[0].wrap_u = wrap;
    const auto paint = load_paint(model, {}, {});
    EXPECT_TRUE(paint);
    const RgbImage image = print(model, *paint, 60, 60, 50.8);
    std::string out;
    for (int half = 0; half < 6; ++half) {
      out += image.at((2 * half + 1) * image.width / 12, image.height / 2)[0] < 128 ? 'd' : 'r';
    }
    return out;
  };
  EXPECT_EQ(dark(mesh::Wrap::kRepeat), "drdrdr");
  EXPECT_EQ(dark(mesh::Wrap::kMirror), "rddrrd");
  EXPECT_EQ(dark(mesh::Wrap::kClamp), "dddrrr");
}

TEST(Paint, ATextureThatFillsItsTileDoesNotWrapAroundAtItsEdges) {
  // The left edge is red and the right edge blue. Repeating must not mix them at the border of the
  // chart.
  const mesh::Model model = plate(-20, -20, 20, 20);
  const Paint paint =
      load(model, make_image(8, 8, [](int x, int) { return x < 4 ? kRed : kBlue; }));
  const RgbImage image = print(model, paint, 40, 40, 100);
  for (int y = 0; y < image.height; ++y) {
    EXPECT_EQ(image.at(1, y)[2], 0);
    EXPECT_EQ(image.at(image.width - 2, y)[0], 0);
  }
}

TEST(Paint, VertexColoursAreMixedInLinearLight) {
  mesh::Model model = plate(-20, -20, 20, 20);
  model.corner_uvs.clear();
  model.vertex_colours = {{0, 0, 0}, {1, 1, 1}, {0, 0, 0}, {1, 1, 1}};
  const auto paint = load_paint(model, {}, {});
  ASSERT_TRUE(paint);
  EXPECT_TRUE(paint->has_colour());
  const RgbImage image = print(model, *paint, 40, 40, 50.8);
  EXPECT_NEAR(image.at(40, 20)[0], srgb8_from_linear(0.5F), 2);
  EXPECT_NEAR(image.at(20, 50)[1], srgb8_from_linear(20.5F / 80), 2);
}

TEST(Paint, MaterialsWithoutTextureGiveTheirColour) {
  mesh::Model model = plate(-20, -20, 20, 20);
  model.materials.resize(2);
  model.materials[0].has_colour = model.materials[1].has_colour = true;
  model.materials[0].colour = {1, 0, 0};
  model.materials[1].colour = {0, 128 / 255.0F, 0};
  model.triangle_material = {0, 1};
  const auto paint = load_paint(model, {}, {});
  ASSERT_TRUE(paint);
  const RgbImage image = print(model, *paint, 40, 40, 50.8);
  EXPECT_EQ(image.at(60, 70)[0], 255);
  EXPECT_EQ(image.at(60, 70)[1], 0);
  EXPECT_EQ(image.at(20, 10)[0], 0);
  EXPECT_EQ(image.at(20, 10)[1], 128);
}

/// A plate with one material that multiplies, as glTF's do, and a texture of one colour.
mesh::Model tinted_plate(const TemporaryFolder& folder, const std::array<int, 4>& rgba) {
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 16; ++i)
    for (const int value : rgba) pixels.push_back(static_cast<std::uint8_t>(value));
  EXPECT_TRUE(write_png_rgba(folder / "t.png", 4, 4, pixels));
  mesh::Model model = plate(-20, -20, 20, 20);
  model.materials.resize(1);
  model.materials[0].multiplies = true;
  model.materials[0].has_colour = true;
  model.materials[0].texture = folder / "t.png";
  model.triangle_material = {0, 0};
  return model;
}

/// Expects this linear colour in the middle of the plate.
void expect_printed(const mesh::Model& model, const Eigen::Vector3f& linear) {
  const auto paint = load_paint(model, {}, {});
  ASSERT_TRUE(paint) << paint.error().message;
  const RgbImage image = print(model, *paint, 40, 40, 25.4);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(image.at(20, 12)[k], srgb8_from_linear(linear[k]), 1) << k;
}

Eigen::Vector3f linear_of(int r, int g, int b) {
  return linear_from_srgb(
      Eigen::Vector3f(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)) / 255);
}

TEST(Paint, MaterialsThatMultiplyGiveTheProductInLinearLight) {
  const TemporaryFolder folder;
  mesh::Model model = tinted_plate(folder, {200, 120, 60, 255});
  model.materials[0].alpha_mode = mesh::AlphaMode::kOpaque;
  const Eigen::Vector3f texture = linear_of(200, 120, 60), factor = linear_of(188, 255, 99),
                        vertex = linear_of(255, 150, 220);
  expect_printed(model, texture);
  model.materials[0].colour = srgb_from_linear(factor);
  expect_printed(model, texture.cwiseProduct(factor));
  model.vertex_colours.assign(4, srgb_from_linear(vertex));
  expect_printed(model, texture.cwiseProduct(factor));  // not a factor of this material
  model.materials[0].uses_vertex_colours = true;
  expect_printed(model, texture.cwiseProduct(factor).cwiseProduct(vertex));
  model.materials[0].texture.clear();
  expect_printed(model, factor.cwiseProduct(vertex));
  model.materials[0].multiplies = false;  // OBJ: a colour replaces those of the vertices
  expect_printed(model, factor);
}

TEST(Paint, TheAlphaModeDecidesWhatIsTransparent) {
  const TemporaryFolder folder;
  mesh::Model model = tinted_plate(folder, {200, 120, 60, 102});  // alpha 0.4
  mesh::Material& material = model.materials[0];
  const Eigen::Vector3f texture = linear_of(200, 120, 60), factor = linear_of(188, 255, 99);
  const Eigen::Vector3f tinted = texture.cwiseProduct(factor), white = Eigen::Vector3f::Ones();
  material.colour = srgb_from_linear(factor);
  material.alpha_mode = mesh::AlphaMode::kOpaque;
  expect_printed(model, tinted);
  material.alpha_mode = mesh::AlphaMode::kBlend;
  expect_printed(model, 0.4F * tinted + 0.6F * white);  // the white is not tinted
  material.alpha = 0.5F;
  expect_printed(model, 0.2F * tinted + 0.8F * white);
  material.alpha_mode = mesh::AlphaMode::kMask;
  material.alpha_cutoff = 0.15F;
  expect_printed(model, tinted);
  material.alpha_cutoff = 0.25F;
  expect_printed(model, white);
  material.texture.clear();
  material.alpha_mode = mesh::AlphaMode::kBlend;
  expect_printed(model, 0.5F * factor + 0.5F * white);
}

TEST(Paint, ManyTintsShareOneTexture) {
  // Each copy of the texture would have 16 million texels, and 200 million is the limit.
  const TemporaryFolder folder;
  mesh::Model model = tinted_plate(folder, {255, 255, 255, 255});
  ASSERT_TRUE(
      write_png(folder / "t.png", make_image(4096, 4096, [](int, int) { return kWhite; }), 72));
  model.materials[0].alpha_mode = mesh::AlphaMode::kOpaque;
  for (int i = 1; i < 40; ++i) {
    model.materials.push_back(model.materials[0]);
    model.materials.back().colour = {1, 0.02F * static_cast<float>(i), 0};
    model.triangles.push_back(model.triangles[0]);
    model.corner_uvs.push_back(model.corner_uvs[0]);
    model.triangle_material.push_back(i);
  }
  EXPECT_TRUE(load_paint(model, {}, {}));
}

TEST(Paint, TrianglesMayHaveColours) {
  mesh::Model model = plate(-20, -20, 20, 20);
  model.triangle_colours = {{1, 0, 0}, {0, 0, 1}};
  model.vertex_colours.assign(4, Eigen::Vector3f::Ones());  // as exporters write them besides
  const auto paint = load_paint(model, {}, {});
  ASSERT_TRUE(paint);
  EXPECT_TRUE(paint->has_colour());
  const RgbImage image = print(model, *paint, 40, 40, 50.8);
  EXPECT_EQ(image.at(60, 70)[0], 255);
  EXPECT_EQ(image.at(60, 70)[2], 0);
  EXPECT_EQ(image.at(20, 10)[0], 0);
  EXPECT_EQ(image.at(20, 10)[2], 255);
}

TEST(Paint, PlainWhiteIsNotAColour) {
  mesh::Model model = plate(-20, -20, 20, 20);
  const auto has_colour = [&] { return load_paint(model, {}, {})->has_colour(); };
  EXPECT_FALSE(has_colour());
  model.vertex_colours.assign(4, Eigen::Vector3f::Ones());
  EXPECT_FALSE(has_colour());
  model.materials.resize(1);
  model.materials[0].has_colour = true;
  model.triangle_material = {0, 0};
  EXPECT_FALSE(has_colour());
  model.vertex_colours[3] = {1, 1, 0};
  EXPECT_TRUE(has_colour());
  model.vertex_colours.clear();
  model.materials[0].colour = {0, 0, 0};
  EXPECT_TRUE(has_colour());
}

TEST(Paint, TheShareWithoutColourIsSaid) {
  mesh::Model model = plate(-20, -20, 20, 20);
  model.materials.resize(2);
  model.materials[0].has_colour = true;
  model.materials[0].colour = {1, 0, 0};
  model.materials[1].name = "handle";
  model.not_understood = {"material \"handle\": ACME_paint"};
  model.triangle_material = {0, 1};
  const auto paint = load_paint(model, {}, {});
  ASSERT_TRUE(paint);
  EXPECT_TRUE(paint->has_colour());
  ASSERT_TRUE(has_warning(*paint, WarningCode::COLOUR_MISSING_IN_PART));
  const std::string& message = paint->warnings().back().message;
  for (const char* part : {"1 triangles", "50", "\"handle\"", "ACME_paint"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(Paint, AnUnusedMaterialsTextureNeedNotExist) {
  mesh::Model model = plate(-20, -20, 20, 20);
  model.materials.resize(2);
  model.materials[0].name = "skin";
  model.materials[0].texture = "/nowhere/skin.png";
  model.triangle_material = {1, 1};
  EXPECT_TRUE(load_paint(model, {}, {}));
  model.triangle_material = {1, 0};
  const auto paint = load_paint(model, {}, {});
  ASSERT_FALSE(paint);
  EXPECT_EQ(paint.error().code, Code::kNotFound);
  for (const char* part : {"plate.obj", "skin", "/nowhere/skin.png"}) {
    EXPECT_NE(paint.error().message.find(part), std::string::npos) << paint.error().message;
  }
  // If another texture is given, the missing one is not needed.
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "t.png", make_image(4, 4, [](int, int) { return kRed; }), 72));
  EXPECT_TRUE(load_paint(model, folder / "t.png", {}));
}

TEST(Paint, EmbeddedTexturesAreReadFromTheirBytes) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "t.png", make_image(4, 4, [](int, int) { return kBlue; }), 72));
  std::ifstream file(folder / "t.png", std::ios::binary);
  mesh::Model model = plate(-20, -20, 20, 20);
  model.materials.resize(2);
  for (auto& material : model.materials) {
    material.name = "glass";
    material.texture_bytes = {std::istreambuf_iterator<char>(file), {}};
  }
  model.triangle_material = {0, 0};
  const auto paint = load_paint(model, {}, {});
  ASSERT_TRUE(paint) << paint.error().message;
  EXPECT_EQ(print(model, *paint, 40, 40, 50).at(40, 40)[2], 255);
  model.materials[0].texture_bytes.resize(40);
  const auto cut = load_paint(model, {}, {});
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().message.find("glass"), std::string::npos) << cut.error().message;
}

TEST(Paint, ATextureForAModelWithoutUvsIsRefused) {
  mesh::Model model = plate(-20, -20, 20, 20);
  model.corner_uvs.clear();
  const TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder / "t.png", make_image(4, 4, [](int, int) { return kRed; }), 72));
  const auto paint = load_paint(model, folder / "t.png", {});
  ASSERT_FALSE(paint);
  EXPECT_EQ(paint.error().code, Code::kInvalidArgument);
  for (const char* part : {"plate.obj", "t.png", "UVs"}) {
    EXPECT_NE(paint.error().message.find(part), std::string::npos) << paint.error().message;
  }
}

TEST(Paint, WarnsOfItsAssumptions) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> rgba(16, 100);
  ASSERT_TRUE(write_png_rgba(folder / "t.png", 2, 2, rgba));
  mesh::Model model = plate(-20, -20, 20, 20);
  model.corner_uvs[1][0].x() = std::nanf("");
  const auto paint = load_paint(model, folder / "t.png", {});
  ASSERT_TRUE(paint);
  EXPECT_TRUE(has_warning(*paint, WarningCode::ALPHA_OVER_WHITE));
  EXPECT_TRUE(has_warning(*paint, WarningCode::UVS_MISSING_IN_PART));
}

TEST(Texture, ShortcutsMatchFullSampling) {
  std::mt19937 random(5);
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Texels texels{40, 30, std::vector<Texel>(40 * 30)};
  for (std::size_t i = 0; i < texels.texels.size(); ++i) {
    const auto colour = [&] { return static_cast<std::uint16_t>(random() % 65536); };
    texels.texels[i] = {colour(), colour(), colour(), static_cast<std::uint16_t>(1 + i % 40 / 20)};
  }
  using mesh::Wrap;
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kClamp, Wrap::kMirror}) {
    const Texture texture = Texture::build(texels, wrap, wrap, {}).value();
    int short_ways = 0, long_ways = 0;
    for (int k = 0; k < 4000; ++k) {
      Chart chart;
      chart.id = static_cast<std::uint16_t>(k % 3);
      if (k % 2 == 1) chart = {chart.id, {true, true}, {-1, 2}};
      Eigen::Vector2d uv(number(-1.5, 1.5), number(1, 4));
      if (wrap == Wrap::kClamp) uv = {number(-0.2, 1.2), number(-0.2, 1.2)};
      Eigen::Matrix2d per_sample;
      per_sample << number(-0.02, 0.02), number(-0.02, 0.02), number(-0.02, 0.02),
          number(-0.02, 0.02);
      const Texture::Footprint footprint = texture.footprint(per_sample);
      const Eigen::Vector2d offset(number(-9, 9), number(-9, 9));
      Eigen::Vector3f colour;
      if (!texture.shortcut(uv, per_sample, footprint, chart).sample(offset, colour)) {
        ++long_ways;
        continue;
      }
      ++short_ways;
      const Eigen::Vector3f wanted = texture.sample(uv + per_sample * offset, footprint, chart);
      ASSERT_LT((colour - wanted).cwiseAbs().maxCoeff(), 1e-5) << k;
    }
    EXPECT_GT(long_ways, 100);
    EXPECT_TRUE(wrap == Wrap::kMirror ? short_ways == 0 : short_ways > 500) << short_ways;
  }
}

TEST(Paint, WildUvsNeitherCrashNorHang) {
  const RgbImage texture = make_image(64, 64, [](int x, int) { return x < 32 ? kRed : kWhite; });
  for (const float scale : {1e4F, 1e9F, 1e30F}) {
    mesh::Model model = plate(-20, -20, 20, 20, 4, 4);
    for (auto& uvs : model.corner_uvs) {
      for (auto& uv : uvs) uv *= scale;
    }
    const RgbImage image = print(model, load(model, texture), 40, 40, 50);
    EXPECT_EQ(image.at(40, 40)[0], 255);
  }
}

}  // namespace
}  // namespace hydroprint::image
