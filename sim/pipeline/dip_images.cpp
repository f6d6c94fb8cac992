#include "sim/pipeline/dip_images.h"

#include <utility>

namespace hydroprint::pipeline {

Result<DipImages> draw_share(const DipShare& share, const mesh::Surface& surface,
                             const std::vector<flow::MappedTriangle>& tiles,
                             const film::Outline& outline, double dpi, const Context& context) {
  const image::Weight weight = [&share](int triangle, const Eigen::Vector3d& at) {
    return static_cast<float>(share.weights.of_dip(share.dip, triangle, at));
  };
  DipImages out;
  HP_ASSIGN_OR_RETURN(out.complete,
                      image::film_image(surface, tiles, share.paint, outline, dpi, context));
  HP_ASSIGN_OR_RETURN(out.mask, image::film_mask(tiles, weight, outline, dpi, context));
  out.film = image::seen_through(out.mask, out.complete);
  return out;
}

FilmDrawing drawing_of(const DipShare& share, const film::Outline& outline) {
  return [share, outline](const mesh::Surface& surface,
                          const std::vector<flow::MappedTriangle>& tiles, double dpi,
                          const Context& context) -> Result<image::RgbImage> {
    HP_ASSIGN_OR_RETURN(DipImages images, draw_share(share, surface, tiles, outline, dpi, context));
    return std::move(images.film);
  };
}

}  // namespace hydroprint::pipeline
