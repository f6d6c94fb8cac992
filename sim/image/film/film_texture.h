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

/// The part of the film's plane that an image covers.
struct ImageExtent {
  Eigen::Vector2d low_mm, size_mm;  ///< lower left corner; width and height
};

/// The extent of an image of a film. An image whose size is that of the film at a whole number of
/// dots per inch has exactly that pitch and is centred (as film_image makes them). Any other image
/// is fitted to the film's bounding box.
[[nodiscard]] ImageExtent image_extent(int width, int height, const film::Outline& outline);

/// A film image placed on its film, with colour look-up by position.
class FilmTexture {
 public:
  /// Reads a PNG, JPEG or TIFF at the film's size, placed by image_extent(). Fails as read_image()
  /// does.
  [[nodiscard]] static Result<FilmTexture> read(const std::filesystem::path& path,
                                                const film::Outline& outline,
                                                const Context& context);

  /// From an image in memory, reduced by a whole factor until no side is longer than `max_side_px`.
  /// This is fast, and enough for pictures.
  [[nodiscard]] static Result<FilmTexture> from_image(const RgbImage& image,
                                                      const film::Outline& outline, int max_side_px,
                                                      const Context& context);

  /// The film's colour over a patch of a grid of samples.
  /// @param at  three points on the grid (sample (i, j) at (i + 1/2, j + 1/2))
  /// @param film_mm  the points of the film there
  [[nodiscard]] Brush brush(const Corners& at, const Corners& film_mm) const;

  /// Linear colour of the pixel-sized neighbourhood of a point of the film.
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
