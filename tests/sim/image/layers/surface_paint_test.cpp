#include "sim/image/layers/surface_paint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>

#include "tests/sim/image/layers/layer_scenes.h"

namespace hydroprint::image {
namespace {

using namespace testing;
using Eigen::Vector3d;

const Vector3d kMiddle = Vector3d::Constant(1.0 / 3);

/// A surface with layers; the pictures are in its folder.
struct Painted {
  TemporaryFolder folder;
  mesh::Model model;
  mesh::Surface surface;
  LayeredPaint paint;
  std::optional<SurfacePaint> fitted;

  Vector3d codes(int triangle, const Vector3d& at = kMiddle) const {
    return codes_at(*fitted, surface, triangle, at);
  }
};

void load(Painted& painted, const PaintSource& source,
          const Eigen::Matrix3d& R_FO = Eigen::Matrix3d::Identity()) {
  painted.surface = welded_surface(painted.model);
  auto paint = load_layers(painted.model, source, R_FO, {});
  ASSERT_TRUE(paint) << paint.error().message;
  painted.paint = std::move(*paint);
  auto fitted = SurfacePaint::fit(painted.paint, painted.surface, {});
  ASSERT_TRUE(fitted) << fitted.error().message;
  painted.fitted = std::move(*fitted);
}

Layer colour_layer(double r, double g, double b, double opacity) {
  Layer layer;
  layer.name = "layer 1";
  layer.projection = Projection::kDip;
  layer.colour = Eigen::Vector3d(r, g, b).cast<float>();
  layer.opacity = opacity;
  return layer;
}

double linear_of(double code) { return linear_from_srgb(static_cast<float>(code / 255)); }
double code_of(double linear) { return 255 * srgb_from_linear(static_cast<float>(linear)); }

Vector3d centroid(const mesh::Surface& surface, int triangle) {
  Vector3d sum = Vector3d::Zero();
  for (const int v : surface.triangles[static_cast<std::size_t>(triangle)])
    sum += surface.points[static_cast<std::size_t>(v)];
  return sum / 3;
}

Vector3d normal(const mesh::Surface& surface, int triangle) {
  return surface.corner_normals[static_cast<std::size_t>(triangle)][0];
}

TEST(SurfacePaint, LayersMixInLinearLight) {
  Painted painted;
  painted.model = box_model({20, 20, 20}, 1);
  PaintSource source;
  source.base_colour = {0, 0, 1};
  source.layers = {colour_layer(1, 0, 0, 0.5), colour_layer(0, 1, 0, 0.25)};
  load(painted, source);
  const Vector3d codes = painted.codes(0);
  EXPECT_NEAR(codes.x(), code_of(0.75 * 0.5), 0.1);
  EXPECT_NEAR(codes.y(), code_of(0.25), 0.1);
  EXPECT_NEAR(codes.z(), code_of(0.75 * 0.5), 0.1);
}

TEST(SurfacePaint, ATransparentPictureShowsWhatIsBelow) {
  Painted painted;
  painted.model = box_model({20, 20, 20}, 1);
  // Red with an opacity of 128 / 255 everywhere.
  std::vector<std::uint8_t> rgba;
  for (int i = 0; i < 16; ++i) rgba.insert(rgba.end(), {200, 40, 0, 128});
  ASSERT_TRUE(write_png_rgba(painted.folder / "glass.png", 4, 4, rgba));
  Layer layer;
  layer.name = "\"glass.png\"";
  layer.picture = painted.folder / "glass.png";
  PaintSource source;
  const double a = 128.0 / 255;
  for (const double base : {0.0, 100.0, 255.0}) {
    source.base_colour = Eigen::Vector3f::Constant(static_cast<float>(base / 255));
    for (const Projection projection :
         {Projection::kPlanar, Projection::kCylindrical, Projection::kBox}) {
      layer.projection = projection;
      source.layers = {layer};
      load(painted, source);
      for (const int triangle : {0, 5, 11}) {
        const Vector3d codes = painted.codes(triangle);
        EXPECT_NEAR(codes.x(), code_of(a * linear_of(200) + (1 - a) * linear_of(base)), 0.2);
        EXPECT_NEAR(codes.y(), code_of(a * linear_of(40) + (1 - a) * linear_of(base)), 0.2);
      }
    }
  }
}

TEST(SurfacePaint, ADecalEndsAtItsEdgesAndFacesOneSide) {
  Painted painted;
  painted.model = box_model({40, 40, 40}, 20);
  Layer layer = colour_layer(1, 0, 0, 1);
  layer.projection = Projection::kDecal;
  layer.direction = Vector3d(0, 1, 0);
  layer.position_mm = Vector3d(4, -20, -6);
  layer.size_mm = 16;
  layer.depth_mm = 10;
  PaintSource source;
  source.layers = {layer};
  load(painted, source);
  EXPECT_TRUE(painted.fitted->warnings().empty());
  for (int t = 0; t < static_cast<int>(painted.surface.triangles.size()); ++t) {
    const Vector3d p = centroid(painted.surface, t);
    const bool is_front = normal(painted.surface, t).y() < -0.5;
    const bool is_inside = is_front && std::abs(p.x() - 4) < 8 && std::abs(p.z() + 6) < 8;
    EXPECT_NEAR(painted.codes(t).y(), is_inside ? 0 : 255, 0.1) << p.transpose();
  }
}

TEST(SurfacePaint, ALayerThatCoversNothingIsNamed) {
  Painted painted;
  painted.model = box_model({40, 40, 40}, 4);
  const auto codes = [&](const Layer& layer) {
    PaintSource source;
    source.layers = {layer};
    load(painted, source);
    std::string out;
    for (const Warning& warning : painted.fitted->warnings())
      out += std::string(name_of(warning.code)) + " " + warning.message;
    return out;
  };
  Layer decal = colour_layer(1, 0, 0, 1);
  decal.name = "\"eyes\"";
  decal.projection = Projection::kDecal;
  decal.size_mm = 0.5;
  EXPECT_EQ(codes(decal), "");
  decal.position_mm = Vector3d(0, 0, 0);
  decal.depth_mm = 10;
  const std::string beside = codes(decal);
  EXPECT_TRUE(beside.starts_with("LAYER_COVERS_NOTHING layer \"eyes\"")) << beside;
  decal.position_mm = Vector3d(500, 0, -20);
  EXPECT_NE(codes(decal), "");
  EXPECT_NE(codes(colour_layer(1, 0, 0, 0)).find("opacity"), std::string::npos);
}

/// Returns a smooth picture that repeats: code 128 + 100 sin along x, and along y.
RgbImage waves() {
  return make_image(256, 256, [](int x, int y) {
    const auto wave = [](int at) {
      return static_cast<int>(
          std::lround(128 + 100 * std::sin(2 * std::numbers::pi * (at + 0.5) / 256)));
    };
    return std::array<int, 3>{wave(x), wave(y), 128};
  });
}

TEST(SurfacePaint, ABoxIsContinuousAcrossItsEdgesAndPureFarFromThem) {
  Painted painted;
  painted.model = box_model({60, 40, 50}, 20);
  ASSERT_TRUE(write_png(painted.folder / "w.png", waves(), 72));
  Layer layer;
  layer.name = "\"w.png\"";
  layer.picture = painted.folder / "w.png";
  layer.projection = Projection::kBox;
  layer.size_mm = 50;
  layer.blend_mm = 6;
  PaintSource source;
  source.layers = {layer};
  load(painted, source);
  const auto& s = painted.surface;
  // Welded corners have the same colour on every triangle.
  std::map<int, Vector3d> first;
  double most = 0;
  int pure = 0;
  for (int t = 0; t < static_cast<int>(s.triangles.size()); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int v = s.weld[static_cast<std::size_t>(s.triangles[static_cast<std::size_t>(t)][i])];
      const Vector3d codes = painted.codes(t, Vector3d::Unit(i));
      const auto [known, is_new] = first.emplace(v, codes);
      if (!is_new) most = std::max(most, (known->second - codes).cwiseAbs().maxCoeff());
    }
    // Further than the blend from every edge, a side shows its own plane alone.
    const Vector3d p = centroid(s, t);
    if (normal(s, t).x() < 0.5 || std::abs(p.y()) > 13 || std::abs(p.z()) > 18) continue;
    ++pure;
    const double expected = 128 + 100 * std::sin(2 * std::numbers::pi * (0.5 + p.y() / 50));
    EXPECT_NEAR(painted.codes(t).x(), expected, 1.5);
  }
  EXPECT_LT(most, 1.5);
  EXPECT_GT(pure, 100);
}

TEST(SurfacePaint, ACylinderHasNoLineWhereAPictureThatRepeatsMeetsItself) {
  Painted painted;
  painted.model = box_model({40, 40, 60}, 8);
  for (Vector3d& p : painted.model.vertices) {  // a round column
    const double angle = std::atan2(p.y(), p.x());
    const double r = p.head<2>().cwiseAbs().maxCoeff();
    p.head<2>() = Eigen::Vector2d(r * std::cos(angle), r * std::sin(angle));
  }
  ASSERT_TRUE(write_png(painted.folder / "w.png", waves(), 72));
  Layer layer;
  layer.name = "\"w.png\"";
  layer.picture = painted.folder / "w.png";
  layer.projection = Projection::kCylindrical;
  PaintSource source;
  source.layers = {layer};
  load(painted, source);
  const auto& s = painted.surface;
  int near_seam = 0;
  for (int t = 0; t < static_cast<int>(s.triangles.size()); ++t) {
    for (const Vector3d& at : {kMiddle, Vector3d(0.8, 0.1, 0.1), Vector3d(0.05, 0.05, 0.9)}) {
      Vector3d p = Vector3d::Zero();
      for (int i = 0; i < 3; ++i)
        p +=
            at[i] * s.points[static_cast<std::size_t>(s.triangles[static_cast<std::size_t>(t)][i])];
      if (p.head<2>().norm() < 1) continue;
      const double u = 0.5 + std::atan2(p.x(), -p.y()) / (2 * std::numbers::pi);
      near_seam += u < 0.02 || u > 0.98 ? 1 : 0;
      const double expected = 128 + 100 * std::sin(2 * std::numbers::pi * u);
      EXPECT_NEAR(painted.codes(t, at).x(), expected, 2) << p.transpose();
    }
  }
  EXPECT_GT(near_seam, 10);
}

TEST(SurfacePaint, APictureOnAMeshWithoutCoordinatesIsProjectedAlongTheDip) {
  Painted painted;
  painted.model = box_model({40, 40, 40}, 4);
  ASSERT_TRUE(write_png(painted.folder / "w.png", waves(), 72));
  Layer layer;
  layer.name = "\"w.png\"";
  layer.picture = painted.folder / "w.png";
  PaintSource source;
  source.layers = {layer};
  load(painted, source);
  EXPECT_EQ(painted.paint.layers[0].projection, Projection::kDip);
  ASSERT_EQ(painted.paint.warnings.size(), 1U);
  EXPECT_EQ(painted.paint.warnings[0].code, WarningCode::PICTURE_PROJECTED);
  for (int t = 0; t < static_cast<int>(painted.surface.triangles.size()); ++t) {
    const Vector3d p = centroid(painted.surface, t);
    const double expected = 128 + 100 * std::sin(2 * std::numbers::pi * (0.5 - p.x() / 40));
    EXPECT_NEAR(painted.codes(t).x(), expected, 1.5);
  }
  // A mesh with coordinates uses them.
  painted.model = plate(0, 0, 10, 10);
  load(painted, source);
  EXPECT_EQ(painted.paint.layers[0].projection, Projection::kUv);
  EXPECT_TRUE(painted.paint.warnings.empty());
}

TEST(SurfacePaint, ADecalLiesOverTheModelsOwnColours) {
  Painted painted;
  painted.model = box_model({40, 40, 40}, 4);
  painted.model.vertex_colours.assign(painted.model.vertices.size(), {0, 0.5, 0});
  Layer own;
  own.name = "model";
  own.projection = Projection::kUv;
  Layer decal = colour_layer(1, 0, 0, 1);
  decal.projection = Projection::kDecal;
  decal.direction = Vector3d(0, 1, 0);
  decal.size_mm = 200;
  PaintSource source;
  source.layers = {own, decal};
  load(painted, source);
  for (int t = 0; t < static_cast<int>(painted.surface.triangles.size()); ++t) {
    const bool is_front = normal(painted.surface, t).y() < -0.5;
    EXPECT_NEAR(painted.codes(t).x(), is_front ? 255 : 0, 0.5);
    EXPECT_NEAR(painted.codes(t).y(), is_front ? 0 : 127.5, 0.5);
  }
  own.projection = Projection::kVertexColours;
  source.layers = {own};
  load(painted, source);
  EXPECT_NEAR(painted.codes(3).y(), 127.5, 0.5);
}

TEST(AxisDistance, AgreesWithBruteForceAndDoesNotReachThroughWalls) {
  // A plate of 2 mm: its two large sides have the same axis, and only the rim has others.
  const mesh::Model model = box_model({60, 40, 2}, 12);
  const mesh::Surface surface = welded_surface(model);
  const auto found = axis_distances(surface, Eigen::Matrix3d::Identity(), 100, {});
  ASSERT_TRUE(found);
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    const Vector3d& p = surface.points[v];
    const double to_z = std::abs(p.z()) > 1 - 1e-9 ? 0 : 1 - std::abs(p.z());
    EXPECT_NEAR((*found)[v][2], to_z, 1e-5) << p.transpose();
    if (to_z > 0) continue;
    EXPECT_NEAR((*found)[v][0], 30 - std::abs(p.x()), 1e-5) << p.transpose();
    EXPECT_NEAR((*found)[v][1], 20 - std::abs(p.y()), 1e-5) << p.transpose();
  }
}

TEST(LayeredPaint, PlainWhiteHasNoColour) {
  const mesh::Model model = box_model({10, 10, 10}, 1);
  PaintSource source;
  const auto has_colour = [&] {
    const auto paint = load_layers(model, source, Eigen::Matrix3d::Identity(), {});
    return paint && paint->has_colour();
  };
  EXPECT_FALSE(has_colour());
  source.layers = {colour_layer(1, 1, 1, 1)};
  EXPECT_FALSE(has_colour());
  source.layers = {colour_layer(1, 0, 0, 0)};
  EXPECT_FALSE(has_colour());
  source.layers = {colour_layer(1, 0, 0, 0.1)};
  EXPECT_TRUE(has_colour());
  source = {};
  source.base_colour = {0.9F, 1, 1};
  EXPECT_TRUE(has_colour());
}

TEST(LayeredPaint, WhatAModelLacksAndPicturesThatAreNoneAreRefused) {
  const TemporaryFolder folder;
  const mesh::Model model = box_model({10, 10, 10}, 1);
  Layer layer;
  layer.name = "\"p\"";
  const auto message = [&] {
    PaintSource source;
    source.layers = {layer};
    const auto paint = load_layers(model, source, Eigen::Matrix3d::Identity(), {});
    return paint ? std::string() : paint.error().message;
  };
  layer.projection = Projection::kVertexColours;
  EXPECT_NE(message().find("no colours"), std::string::npos);
  ASSERT_TRUE(write_png(folder / "w.png", waves(), 72));
  layer.picture = folder / "w.png";
  layer.projection = Projection::kUv;
  EXPECT_NE(message().find("texture coordinates"), std::string::npos);
  layer.projection = Projection::kBox;
  layer.picture = folder / "absent.png";
  EXPECT_NE(message().find("absent.png: no such file"), std::string::npos);
  std::ofstream(folder / "words.png") << "not a picture";
  layer.picture = folder / "words.png";
  EXPECT_NE(message().find("words.png"), std::string::npos);
}

}  // namespace
}  // namespace hydroprint::image
