#include "sim/image/film/landed.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "sim/base/check.h"
#include "sim/image/film/film_image.h"
#include "sim/image/io/colour.h"
#include "sim/image/layers/surface_paint.h"
#include "sim/image/texture/raster.h"

namespace hydroprint::image {
namespace {

constexpr int kMaxSide_px = 16384;

int wrap_index(int i, int size) { return ((i % size) + size) % size; }

/// Returns the tile's corners in the texture, in texels, y down, shifted by whole textures so that
/// the tile starts in the first one. NaN if the triangle has no texture coordinates.
Corners texel_corners(const mesh::Model& model, const mesh::Surface& surface,
                      const flow::MappedTriangle& tile, int width, int height) {
  const auto barycentric = model_barycentric(surface, tile);
  const auto& uvs = model.corner_uvs[surface.source_triangle[tile.triangle]];
  Corners at;
  for (int i = 0; i < 3; ++i) {
    Eigen::Vector2d uv = Eigen::Vector2d::Zero();
    for (int k = 0; k < 3; ++k) uv += barycentric[i][k] * uvs[k].cast<double>();
    at[i] = {uv.x() * width, (1 - uv.y()) * height};
  }
  const Eigen::Vector2d low = at[0].cwiseMin(at[1]).cwiseMin(at[2]);
  const Eigen::Vector2d size(width, height);
  const Eigen::Vector2d tiles = low.cwiseQuotient(size).array().floor();
  for (auto& corner : at) corner -= tiles.cwiseProduct(size);
  return at;
}

class LandedTexture {
 public:
  LandedTexture(int width, int height) : times_s_(area(width, height), HUGE_VALF) {
    image_.width = width;
    image_.height = height;
    image_.rgba.assign(4 * times_s_.size(), 255);
    for (std::size_t i = 0; i < times_s_.size(); ++i) image_.rgba[4 * i + 3] = 0;
  }

  void paint(const Corners& at, const std::array<float, 3>& time_s, const Brush& brush) {
    // The window is two textures wide and high, because a tile that starts near the edge of the
    // texture may extend beyond it.
    const Window window{0, 0, 2 * image_.width, 2 * image_.height};
    for_each_sample(at, window, [&](int x, int y, const Eigen::Vector3d& b) {
      const std::size_t texel =
          static_cast<std::size_t>(wrap_index(y, image_.height)) * image_.width +
          wrap_index(x, image_.width);
      const auto landed_s =
          static_cast<float>(b[0] * time_s[0] + b[1] * time_s[1] + b[2] * time_s[2]);
      if (!(landed_s < times_s_[texel])) return;
      times_s_[texel] = landed_s;
      const Eigen::Vector3f colour = brush.at(x + 0.5, y + 0.5);
      for (int c = 0; c < 3; ++c) image_.rgba[4 * texel + c] = encode_(colour[c]);
      image_.rgba[4 * texel + 3] = 255;
    });
  }

  RgbaImage take() { return std::move(image_); }

 private:
  static std::size_t area(int width, int height) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }

  Srgb8Encoder encode_;
  std::vector<float> times_s_;
  RgbaImage image_;
};

}  // namespace

std::vector<Eigen::Vector3f> landed_colours(const flow::SurfaceMap& map, const FilmTexture& film) {
  const Eigen::Vector3f none = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  std::vector<Eigen::Vector3f> colours;
  colours.reserve(map.film_mm.size());
  for (const Eigen::Vector2d& point : map.film_mm) {
    colours.push_back(point.allFinite() ? srgb_from_linear(film.at(point)) : none);
  }
  return colours;
}

Result<RgbaImage> landed_texture(const mesh::Model& model, const mesh::Surface& surface,
                                 const std::vector<flow::MappedTriangle>& tiles,
                                 const FilmTexture& film, int width, int height,
                                 const Context& context) {
  HP_CHECK(width > 0);
  HP_CHECK(height > 0);
  HP_CHECK(surface.source_triangle.size() == surface.triangles.size());
  if (model.corner_uvs.empty()) {
    return fail(Code::kFailedPrecondition,
                model.path.string() +
                    ": has no texture coordinates (UVs), which a texture needs. "
                    "Unwrap the model, or use the colours per vertex");
  }
  if (width < 1 || height < 1 || width > kMaxSide_px || height > kMaxSide_px) {
    return fail(
        Code::kOutOfRange,
        fmt::format("landed texture: {} x {} pixels is out of range. Choose sides from 1 to {}",
                    width, height, kMaxSide_px));
  }
  LandedTexture landed(width, height);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    if (t % 4096 == 0) HP_RETURN_IF_ERROR(check_cancelled(context));
    const flow::MappedTriangle& tile = tiles[t];
    const Corners at = texel_corners(model, surface, tile, width, height);
    landed.paint(at, tile.contact_time_s, film.brush(at, tile.film_mm));
  }
  return landed.take();
}

}  // namespace hydroprint::image
