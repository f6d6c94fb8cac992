#include "sim/pipeline/preview.h"

#include <limits>

namespace hydroprint::pipeline {

DipOptions preview_of(DipOptions options) {
  options.film_model = FilmModel::kStokes;
  options.inertia = false;
  options.ink = {};
  options.surface_edge_mm = std::numeric_limits<double>::infinity();
  options.schedule.swept_mm = 14;
  options.mesh.size = {10, 1, 50};
  options.mesh.spacing_mm = 8;
  options.mesh.tolerance_mm = 0.2;
  options.mesh.least_mm = 1;
  options.map.make_tiles = false;
  return options;
}

}  // namespace hydroprint::pipeline
