#include "sim/image/film/film_texture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/check.h"
#include "sim/image/io/colour.h"

namespace hydroprint::image {
namespace {

/// Means over blocks of `factor` by `factor` pixels, in linear light; the last blocks may be
/// smaller.
Result<Texels> reduce(const RgbImage& image, int factor, const Context& context) {
  HP_CHECK(factor >= 1);
  Texels out;
  out.width = (image.width + factor - 1) / factor;
  out.height = (image.height + factor - 1) / factor;
  out.texels.resize(static_cast<std::size_t>(out.width) * out.height);
  std::array<std::uint32_t, 256> linear;
  for (std::uint32_t i = 0; i < 256; ++i) {
    linear[i] = linear16_from_srgb16(static_cast<std::uint16_t>(i * 257));
  }
  const auto rows = static_cast<std::size_t>(out.height);
  HP_RETURN_IF_ERROR(parallel_for(context, {}, rows, [&](std::size_t row) -> Status {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < out.width; ++x) {
      std::array<std::uint64_t, 3> sum{};
      std::uint64_t count = 0;
      for (int fy = y * factor; fy < std::min((y + 1) * factor, image.height); ++fy) {
        for (int fx = x * factor; fx < std::min((x + 1) * factor, image.width); ++fx, ++count) {
          for (int c = 0; c < 3; ++c) sum[c] += linear[image.at(fx, fy)[c]];
        }
      }
      Texel& texel = out.texels[static_cast<std::size_t>(y) * out.width + x];
      texel.r = static_cast<std::uint16_t>(sum[0] / count);
      texel.g = static_cast<std::uint16_t>(sum[1] / count);
      texel.b = static_cast<std::uint16_t>(sum[2] / count);
    }
    return {};
  }));
  return out;
}

}  // namespace

ImageExtent image_extent(int width, int height, const film::Outline& outline) {
  HP_CHECK(width > 0);
  HP_CHECK(height > 0);
  const double dpi = std::round(width * 25.4 / outline.size_mm().x());
  if (dpi >= 1) {
    const FilmGrid grid = film_grid(outline, 25.4 / dpi);
    if (grid.columns == width && grid.rows == height) {
      const Eigen::Vector2d size_mm = Eigen::Vector2d(width, height) * grid.pitch_mm;
      return {{grid.left_mm, grid.top_mm - size_mm.y()}, size_mm};
    }
  }
  return {outline.min_mm, outline.size_mm()};
}

Result<FilmTexture> FilmTexture::read(const std::filesystem::path& path,
                                      const film::Outline& outline, const Context& context) {
  HP_ASSIGN_OR_RETURN(ReadImage read, read_image(path, context));
  const auto [low, size] = image_extent(read.image.width, read.image.height, outline);
  HP_ASSIGN_OR_RETURN(Texture texture, Texture::build(std::move(read.image), mesh::Wrap::kClamp,
                                                      mesh::Wrap::kClamp, context));
  return FilmTexture(std::move(texture), low, size);
}

Result<FilmTexture> FilmTexture::from_image(const RgbImage& image, const film::Outline& outline,
                                            int max_side_px, const Context& context) {
  const auto [low, size] = image_extent(image.width, image.height, outline);
  const int factor = (std::max(image.width, image.height) + max_side_px - 1) / max_side_px;
  HP_ASSIGN_OR_RETURN(Texels texels, reduce(image, factor, context));
  // Texels are whole, so the last column and row may extend beyond the image.
  const Eigen::Vector2d whole(size.x() * texels.width * factor / image.width,
                              size.y() * texels.height * factor / image.height);
  HP_ASSIGN_OR_RETURN(Texture texture, Texture::build(std::move(texels), mesh::Wrap::kClamp,
                                                      mesh::Wrap::kClamp, context));
  return FilmTexture(std::move(texture), {low.x(), low.y() + size.y() - whole.y()}, whole);
}

Brush FilmTexture::brush(const Corners& at, const Corners& film_mm) const {
  static const Chart kWhole;
  return Brush(texture_, kWhole, at, {uv(film_mm[0]), uv(film_mm[1]), uv(film_mm[2])});
}

Eigen::Vector3f FilmTexture::at(const Eigen::Vector2d& film_mm) const {
  return texture_.sample(uv(film_mm), {}, {});
}

}  // namespace hydroprint::image
