#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/image/film/film_image.h"
#include "sim/image/io/rgb_image.h"
#include "sim/image/texture/paint.h"
#include "sim/image/texture/texture.h"

namespace hydroprint::image {

/// The part of the film's plane that an image lies on.
struct ImageExtent {
  Eigen::Vector2d low_mm, size_mm;  ///< lower left corner; width and height
};

/// Where an image of a film lies: one whose size is that of a whole number of dots per inch has
/// exactly that pitch and is centred (as film_image makes them); any other is fitted to the film's
/// bounding box.
[[nodiscard]] ImageExtent image_extent(int width, int height, const film::Outline& outline);

/// A film image lying on its film, to be looked up by place.
class FilmTexture {
 public:
  /// Reads any PNG, JPEG or TIFF at the film's size; it lies as image_extent says. Refuses what
  /// read_image refuses.
  [[nodiscard]] static Result<FilmTexture> read(const std::filesystem::path& path,
                                                const film::Outline& outline,
                                                const Context& context);

  /// From an image in memory, made smaller by whole numbers until no side is longer than
  /// `max_side_px`: enough for pictures, and cheap.
  [[nodiscard]] static Result<FilmTexture> from_image(const RgbImage& image,
                                                      const film::Outline& outline, int max_side_px,
                                                      const Context& context);

  /// The film's colour over a patch of some grid of samples.
  /// @param at  three places on the grid (sample (i, j) at (i + 1/2, j + 1/2))
  /// @param film_mm  the points of the film there
  [[nodiscard]] Brush brush(const Corners& at, const Corners& film_mm) const;

  /// Linear colour of the pixel-sized neighbourhood of one point of the film.
  [[nodiscard]] Eigen::Vector3f at(const Eigen::Vector2d& film_mm) const;

 private:
  FilmTexture(Texture texture, const Eigen::Vector2d& low_mm, const Eigen::Vector2d& size_mm)
      : texture_(std::move(texture)), low_mm_(low_mm), size_mm_(size_mm) {}
  [[nodiscard]] Eigen::Vector2d uv(const Eigen::Vector2d& film_mm) const {
    return (film_mm - low_mm_).cwiseQuotient(size_mm_);
  }

  Texture texture_;
  Eigen::Vector2d low_mm_, size_mm_;
};

}  // namespace hydroprint::image
