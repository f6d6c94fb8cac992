#include <array>
#include <cmath>

#include "sim/sample/chart.h"
#include "sim/sample/textured_mesh.h"

namespace hydroprint::sample {
namespace {

constexpr double kSideMm = 120;
constexpr double kThickMm = 10;

/// Lines each 10 mm, finer ones each 2 mm, on a ground whose colour tells the place.
Colour grid_colour(double x, double y, const Colour& left, const Colour& right) {
  Colour colour = mix(left, right, x / kSideMm);
  colour = mix(colour, {1, 1, 1}, 0.6 * y / kSideMm);
  const auto line = [&](double spacing, double width) {
    const double d = std::min(to_nearest_line(x, spacing), to_nearest_line(y, spacing));
    return d < width / 2;
  };
  if (line(2, 0.15)) colour = mix(colour, {0, 0, 0}, 0.25);
  if (line(10, 0.5)) colour = {0.08F, 0.08F, 0.10F};
  if (std::abs(x - kSideMm / 2) < 0.6 || std::abs(y - kSideMm / 2) < 0.6)
    colour = {0.80F, 0.08F, 0.08F};
  if (std::hypot(x - 15, y - 15) < 4) colour = {0.05F, 0.25F, 0.75F};  // one corner differs
  return colour;
}

Chart grid_chart(double x_mm, double y_mm, double height_mm, const Colour& left,
                 const Colour& right) {
  return {{x_mm, y_mm}, {kSideMm, height_mm}, [=](double x, double y) {
            return grid_colour(x, y, left, right);
          }};
}

}  // namespace

Sample make_board() {
  const Colour sky(0.62F, 0.82F, 0.95F);
  const Colour sand(0.98F, 0.86F, 0.60F);
  const Colour leaf(0.70F, 0.90F, 0.68F);
  const Colour rose(0.97F, 0.75F, 0.80F);
  Sheet sheet;
  sheet.size_mm = {260, 160};
  sheet.charts = {
      grid_chart(5, 35, kSideMm, sky, sand),    grid_chart(135, 35, kSideMm, leaf, rose),
      grid_chart(5, 5, kThickMm, sky, sky),     grid_chart(5, 20, kThickMm, sand, sand),
      grid_chart(135, 5, kThickMm, leaf, leaf), grid_chart(135, 20, kThickMm, rose, rose)};

  Sample sample;
  auto& mesh = sample.mesh;
  for (int i = 0; i < 8; ++i)
    mesh.add_vertex({((i & 1) != 0 ? 0.5 : -0.5) * kSideMm, ((i & 2) != 0 ? 0.5 : -0.5) * kSideMm,
                     (i & 4) != 0 ? kThickMm : 0});
  // Top, bottom (which is dipped first), then the sides; each from its lower left corner outside.
  const std::array<std::array<int, 4>, 6> quads = {
      {{4, 5, 7, 6}, {1, 0, 2, 3}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}}};
  for (std::size_t q = 0; q < quads.size(); ++q) {
    const auto& size = sheet.charts[q].size_mm;
    const std::array<Eigen::Vector2d, 4> places = {
        {{0, 0}, {size.x(), 0}, {size.x(), size.y()}, {0, size.y()}}};
    std::vector<TexturedMesh::Corner> corners;
    for (std::size_t k = 0; k < 4; ++k)
      corners.push_back({quads[q][k], mesh.add_uv(sheet.uv(q, places[k]))});
    mesh.add_face(std::move(corners));
  }
  sample.texture = sheet.draw();
  sample.px_per_mm = sheet.px_per_mm;
  return sample;
}

}  // namespace hydroprint::sample
