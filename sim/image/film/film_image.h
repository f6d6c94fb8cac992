#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/flow/surface_map.h"
#include "sim/image/io/rgb_image.h"
#include "sim/image/layers/surface_paint.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image {

/// Square cells over the film, centred on it. The centre of cell (i, j) is at left + (i + 1/2)
/// pitch, top - (j + 1/2) pitch, seen from above, row 0 at the top.
struct FilmGrid {
  int columns = 0, rows = 0;
  double pitch_mm = 1;
  double left_mm = 0, top_mm = 0;

  /// Converts a point of the film to cell coordinates; y down.
  [[nodiscard]] Eigen::Vector2d cell(const Eigen::Vector2d& film_mm) const {
    return {(film_mm.x() - left_mm) / pitch_mm, (top_mm - film_mm.y()) / pitch_mm};
  }
};

/// Returns the grid with the given pitch. Its number of cells is the film's size divided by the
/// pitch, rounded, at least 1.
[[nodiscard]] FilmGrid film_grid(const film::Outline& outline, double pitch_mm);

inline constexpr double kMinDpi = 20, kMaxDpi = 2400;
inline constexpr double kMaxFilmImage_px = 400e6;

/// Computes the image to print (end of section 4.5). Every point of the film gets the colour of the
/// surface point where it lands, or white if it does not land. The image shows the ink side, seen
/// from above. Pixels at edges of the covered region have four samples; the texture is filtered
/// over the pixel's footprint. Film that has landed does not move, so the earlier contact wins
/// where tiles overlap. The result is bit-identical for any number of threads. Errors: kOutOfRange
/// for dpi outside [kMinDpi, kMaxDpi] and images larger than kMaxFilmImage_px.
[[nodiscard]] Result<RgbImage> film_image(const mesh::Surface& surface,
                                          const std::vector<flow::MappedTriangle>& tiles,
                                          const SurfacePaint& paint, const film::Outline& outline,
                                          double dpi, const Context& context);

/// Returns how much of the colour of a surface point a film prints, in [0, 1]. Called from several
/// threads.
/// @param triangle  index into Surface::triangles
using Weight = std::function<float(int triangle, const Eigen::Vector3d& barycentric)>;

/// Computes the mask of a film image: the weight of the surface point where each point of the film
/// lands, as a grey of 255 times the weight; 0 where it does not land. Drawn like film_image(), but
/// pixels at edges of the covered region have the mean weight of the covered part. Same errors.
[[nodiscard]] Result<RgbImage> film_mask(const std::vector<flow::MappedTriangle>& tiles,
                                         const Weight& weight, const film::Outline& outline,
                                         double dpi, const Context& context);

/// Returns an image as seen through a mask of the same size, on white: w c + (1 - w) white for each
/// coded channel c, where w is the mask's channel divided by 255 (section 6 of the paper).
[[nodiscard]] RgbImage seen_through(const RgbImage& mask, const RgbImage& image);

}  // namespace hydroprint::image
