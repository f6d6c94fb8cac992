#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/flow/jacobian.h"
#include "sim/flow/surface_map.h"
#include "sim/image/film/film_image.h"
#include "sim/waterline/body.h"
#include "tests/sim/flow/particles.h"

namespace hydroprint::flow::reference {

using Pixel = Eigen::Vector2i;  ///< column and row of a film image

/// The fast map as the film image takes it: which tile lies under the middle of each pixel, that of
/// the earliest contact where there are several.
class PixelMap {
 public:
  /// Body and tiles must outlive the map.
  PixelMap(const waterline::Body& body, const std::vector<MappedTriangle>& tiles,
           const image::FilmGrid& grid);

  /// What lands on a pixel's middle.
  struct Spot {
    int triangle = 0;
    Eigen::Vector3d barycentric;
    Eigen::Vector3d point_mm;   ///< as the body lies
    Gradient film_per_surface;  ///< of the tile
  };
  [[nodiscard]] std::optional<Spot> at(const Pixel& pixel) const;

  [[nodiscard]] Eigen::Vector2d film_mm(const Pixel& pixel) const;
  [[nodiscard]] const image::FilmGrid& grid() const { return grid_; }

  /// True if the map jumps, begins or ends between the pixel and the next in its row or column: it
  /// goes further than its gradient says by more than a pixel.
  [[nodiscard]] bool is_at_jump(const Pixel& pixel) const;

 private:
  [[nodiscard]] std::size_t index(const Pixel& pixel) const {
    return static_cast<std::size_t>(pixel.y()) * grid_.columns + pixel.x();
  }

  const waterline::Body& body_;
  const std::vector<MappedTriangle>& tiles_;
  image::FilmGrid grid_;
  std::vector<int> tile_;  ///< per pixel; -1: nothing lands there
};

/// What the fast map and a particle say of one pixel.
struct PixelError {
  bool lands = false;     ///< by either of them
  bool is_ruled = false;  ///< the particle meets a face that film cannot follow, by rule: no error
  /// How far on the film the particle would have to start to land where the map says; infinite if
  /// only one of them lands.
  double error_mm = 0;
};

/// One particle per pixel, against the fast map.
class PixelComparison {
 public:
  PixelComparison(const PixelMap& map, const waterline::Body& body, const Particles& particles);

  [[nodiscard]] PixelError at(const Pixel& pixel) const;

  /// How far on the film other particles land from these; 0 where neither lands, infinite where one
  /// of them does or the map knows of no film there.
  [[nodiscard]] double moved_mm(const Pixel& pixel, const Particles& others) const;

  /// By how much the map misplaces a jump at this pixel, on the film: the distance to the nearest
  /// particle that does what the map says of the pixel (up to half a pixel), or that lands apart
  /// from where the pixel's own does: the particles' jump lies between the two then. Looked for on
  /// rings of growing radius; 0 where map and particle agree, infinite beyond 4 mm.
  [[nodiscard]] double jump_distance_mm(const Pixel& pixel) const;

 private:
  [[nodiscard]] PixelError compare(const std::optional<PixelMap::Spot>& spot,
                                   const std::optional<Particles::Contact>& contact,
                                   const Eigen::Vector2d& offset_mm) const;
  [[nodiscard]] bool are_apart(const std::optional<Particles::Contact>& a,
                               const std::optional<Particles::Contact>& b,
                               double film_distance_mm) const;

  const PixelMap& map_;
  const waterline::Body& body_;
  const Particles& particles_;
};

}  // namespace hydroprint::flow::reference
