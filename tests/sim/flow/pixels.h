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

/// The fast map as used by the film image: the tile under the middle of each pixel. If there are
/// several, the one with the earliest contact.
class PixelMap {
 public:
  /// Body and tiles must outlive the map.
  PixelMap(const waterline::Body& body, const std::vector<MappedTriangle>& tiles,
           const image::FilmGrid& grid);

  /// The landing point of a pixel's middle.
  struct Spot {
    int triangle = 0;
    Eigen::Vector3d barycentric;
    Eigen::Vector3d point_mm;   ///< on the body in its place over the film
    Gradient film_per_surface;  ///< of the tile
  };
  [[nodiscard]] std::optional<Spot> at(const Pixel& pixel) const;

  [[nodiscard]] Eigen::Vector2d film_mm(const Pixel& pixel) const;
  [[nodiscard]] const image::FilmGrid& grid() const { return grid_; }

  /// True if the map jumps, begins or ends between the pixel and the next one in its row or column:
  /// it moves farther than its gradient predicts by more than a pixel.
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

/// Comparison of the fast map and a particle at one pixel.
struct PixelError {
  bool lands = false;     ///< in the map or as a particle
  bool is_ruled = false;  ///< the particle meets a face excluded by rule for film: not an error
  /// Distance on the film between the particle and one that would land where the map says; infinite
  /// if only one of map and particle lands.
  double error_mm = 0;
};

/// Compares one particle per pixel with the fast map.
class PixelComparison {
 public:
  PixelComparison(const PixelMap& map, const waterline::Body& body, const Particles& particles);

  [[nodiscard]] PixelError at(const Pixel& pixel) const;

  /// Distance on the film between the landing points of other particles and these. 0 if neither
  /// lands; infinite if only one lands or the map has no film there.
  [[nodiscard]] double moved_mm(const Pixel& pixel, const Particles& others) const;

  /// Error of the map, on the film, in the position of a jump at this pixel. It is the distance to
  /// the nearest particle that agrees with the map at this pixel (up to half a pixel), or that
  /// lands apart from the pixel's own particle. In the second case the particles' jump lies between
  /// the two. The search uses rings of growing radius. 0 if map and particle agree, infinite beyond
  /// 4 mm.
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
