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

/// The part of the film plane that an image covers.
struct ImageExtent {
  Eigen::Vector2d low_mm, size_mm;  ///< lower left corner; width and height
};

/// Returns the extent of an image of a film. An image with exactly the film's size at a whole
/// number of dots per inch has that resolution and is centred, like the images of film_image(). Any
/// other image is fitted to the film's bounding box.
[[nodiscard]] ImageExtent image_extent(int width, int height, const film::Outline& outline);

/// A film image placed on its film, with colour look-up by position.
class FilmTexture {
 public:
  /// Reads a PNG, JPEG or TIFF image and places it on the film with image_extent(). Returns the
  /// errors of read_image().
  [[nodiscard]] static Result<FilmTexture> read(const std::filesystem::path& path,
                                                const film::Outline& outline,
                                                const Context& context);

  /// Creates a texture from an image in memory, reduced by a whole factor until no side is longer
  /// than `max_side_px`. This is fast, and sufficient for pictures.
  [[nodiscard]] static Result<FilmTexture> from_image(const RgbImage& image,
                                                      const film::Outline& outline, int max_side_px,
                                                      const Context& context);

  /// Returns a brush for the film's colours over a patch of a sample grid.
  /// @param at       three points on the grid (sample (i, j) at (i + 1/2, j + 1/2))
  /// @param film_mm  the film points at these grid points
  [[nodiscard]] Brush brush(const Corners& at, const Corners& film_mm) const;

  /// Returns the mean linear colour of a pixel-sized neighbourhood of a film point.
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
