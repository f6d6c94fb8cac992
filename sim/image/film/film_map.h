#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/flow/surface_map.h"
#include "sim/image/film/film_image.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image {

/// The landing point of each cell of a grid over the film, row 0 at the top (+y). NaN where no film
/// is transferred.
struct FilmMap {
  FilmGrid grid;
  std::vector<Eigen::Vector3f> contact_mm;  ///< contact point on the object, frame O
  std::vector<float> time_s;                ///< time of contact, since the start of the dip
  std::vector<float> stretch;               ///< largest singular value there (section 6)
};

/// Evaluates the map at the cells' centres; the earliest contact wins where tiles overlap. Errors:
/// kOutOfRange for cells below 0.05 mm or larger than the film.
[[nodiscard]] Result<FilmMap> film_map(const mesh::Surface& surface, const flow::FlowMap& map,
                                       const film::Outline& outline, double cell_mm,
                                       const Context& context);

/// Writes film_map.exr: float channels X, Y, Z, T, stretch, zip-compressed.
[[nodiscard]] Status write_film_map_exr(const std::filesystem::path& path, const FilmMap& map);

}  // namespace hydroprint::image
