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

/// The fast map as used by the film image. Each pixel uses the tile under its middle or, if there
/// are several, the one with the earliest contact.
class PixelMap {
 public:
  /// Body and tiles must outlive the map.
  PixelMap(const waterline::Body& body, const std::vector<MappedTriangle>& tiles,
           const image::FilmGrid& grid);

  /// The landing point of a pixel's middle.
  struct Spot {
    int triangle = 0;
    Eigen::Vector3d barycentric;
    Eigen::Vector3d point_mm;   ///< point on the body, in the film frame
    Gradient film_per_surface;  ///< derivative of the tile's map
  };
  [[nodiscard]] std::optional<Spot> at(const Pixel& pixel) const;

  [[nodiscard]] Eigen::Vector2d film_mm(const Pixel& pixel) const;
  [[nodiscard]] const image::FilmGrid& grid() const { return grid_; }

  /// True if the map jumps, begins or ends between the pixel and the next one in its row or column.
  /// At a jump, the landing point moves by over a pixel more than the gradient predicts.
  [[nodiscard]] bool is_at_jump(const Pixel& pixel) const;

 private:
  [[nodiscard]] std::size_t index(const Pixel& pixel) const {
    return static_cast<std::size_t>(pixel.y()) * grid_.columns + pixel.x();
  }

  const waterline::Body& body_;
  const std::vector<MappedTriangle>& tiles_;
  image::FilmGrid grid_;
  std::vector<int> tile_;  ///< tile of each pixel; -1: nothing lands there
};

/// Comparison of the fast map and a particle at one pixel.
struct PixelError {
  bool lands = false;     ///< according to the map or the particle
  bool is_ruled = false;  ///< the particle meets a face on which film is excluded by rule, so the
                          ///< error does not count
  /// Distance on the film between the particle and a particle that would land at the point of the
  /// map; infinite if there is a landing point only in the map or only for the particle.
  double error_mm = 0;
};

/// Compares one particle per pixel with the fast map.
class PixelComparison {
 public:
  PixelComparison(const PixelMap& map, const waterline::Body& body, const Particles& particles);

  [[nodiscard]] PixelError at(const Pixel& pixel) const;

  /// Distance between the landing points of this pixel in `others` and in the compared particles,
  /// converted to a distance on the film. 0 if neither lands; infinite if only one lands or the map
  /// has no film there.
  [[nodiscard]] double moved_mm(const Pixel& pixel, const Particles& others) const;

  /// Error of the map, on the film, in the position of a jump at this pixel. It is the distance to
  /// the nearest particle that agrees with the map at this pixel (up to half a pixel), or that
  /// lands far from the pixel's own particle. In the second case, the particles jump between the
  /// two. The search uses rings of growing radius. 0 if map and particle agree; infinite beyond 4
  /// mm.
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
