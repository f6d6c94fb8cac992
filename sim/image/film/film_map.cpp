#include "sim/image/film/film_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/image/film/stretch.h"
#include "sim/image/film/tile_bins.h"
#include "sim/image/io/image_file.h"

namespace hydroprint::image {
namespace {

constexpr int kBlock = 64;
constexpr double kMinCell_mm = 0.05;

void draw(const mesh::Surface& surface, const flow::SurfaceMap& values,
          const flow::MappedTriangle& tile, const Window& window, FilmMap& out) {
  const Corners at = {out.grid.cell(tile.film_mm[0]), out.grid.cell(tile.film_mm[1]),
                      out.grid.cell(tile.film_mm[2])};
  const auto points = tile_points(surface, tile);
  const auto stretch = tile_stretch(surface, values, tile);
  for_each_sample(at, window, [&](int x, int y, const Eigen::Vector3d& b) {
    const std::size_t cell = static_cast<std::size_t>(y) * out.grid.columns + x;
    const auto time_s =
        static_cast<float>(b[0] * tile.contact_time_s[0] + b[1] * tile.contact_time_s[1] +
                           b[2] * tile.contact_time_s[2]);
    if (out.time_s[cell] <= time_s) return;  // false while it is still NaN
    out.time_s[cell] = time_s;
    out.contact_mm[cell] = (b[0] * points[0] + b[1] * points[1] + b[2] * points[2]).cast<float>();
    out.stretch[cell] =
        static_cast<float>(b[0] * stretch[0] + b[1] * stretch[1] + b[2] * stretch[2]);
  });
}

}  // namespace

Result<FilmMap> film_map(const mesh::Surface& surface, const flow::FlowMap& map,
                         const film::Outline& outline, double cell_mm, const Context& context) {
  if (!(cell_mm >= kMinCell_mm && cell_mm <= outline.size_mm().minCoeff())) {
    return fail(Code::kOutOfRange,
                fmt::format("film map: cell size {} mm is out of range. Choose a size "
                            "from {} mm to the film's shorter side",
                            cell_mm, kMinCell_mm));
  }
  FilmMap out;
  out.grid = film_grid(outline, cell_mm);
  const std::size_t cells = static_cast<std::size_t>(out.grid.columns) * out.grid.rows;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  out.contact_mm.assign(cells, Eigen::Vector3f::Constant(nan));
  out.time_s.assign(cells, nan);
  out.stretch.assign(cells, nan);
  const TileBins bins(map.tiles, out.grid, kBlock);
  HP_RETURN_IF_ERROR(parallel_for(context, {}, bins.count(), [&](std::size_t b) {
    for (const int t : bins.tiles(b)) {
      draw(surface, map.surface, map.tiles[t], bins.window(b), out);
    }
    return Status{};
  }));
  return out;
}

Status write_film_map_exr(const std::filesystem::path& path, const FilmMap& map) {
  std::vector<float> values;
  values.reserve(5 * map.time_s.size());
  for (std::size_t i = 0; i < map.time_s.size(); ++i) {
    const Eigen::Vector3f& p = map.contact_mm[i];
    values.insert(values.end(), {p.x(), p.y(), p.z(), map.time_s[i], map.stretch[i]});
  }
  return write_exr(path, map.grid.columns, map.grid.rows, {"X", "Y", "Z", "T", "stretch"}, values);
}

}  // namespace hydroprint::image
