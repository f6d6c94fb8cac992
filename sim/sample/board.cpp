#include <array>
#include <cmath>

#include "sim/sample/chart.h"
#include "sim/sample/textured_mesh.h"

namespace hydroprint::sample {
namespace {

constexpr double kSideMm = 120;
constexpr double kThickMm = 10;
constexpr double kLineMm = 10;  // spacing of lines; the mesh has a vertex at each crossing

/// Lines every 10 mm and finer ones every 2 mm. The background colour varies with the position.
Colour grid_colour(double x, double y, const Colour& left, const Colour& right) {
  Colour colour = mix(left, right, x / kSideMm);
  colour = mix(colour, {1, 1, 1}, 0.6 * y / kSideMm);
  const auto line = [&](double spacing, double width) {
    const double d = std::min(to_nearest_line(x, spacing), to_nearest_line(y, spacing));
    return d < width / 2;
  };
  if (line(2, 0.15)) colour = mix(colour, {0, 0, 0}, 0.25);
  if (line(kLineMm, 0.5)) colour = {0.08F, 0.08F, 0.10F};
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

/// Adds one side, divided at the crossings of its lines.
void add_side(TexturedMesh& mesh, const Eigen::Vector3d& origin, const Eigen::Vector3d& right,
              const Eigen::Vector3d& up, std::size_t chart, const Sheet& sheet) {
  const Eigen::Vector2d& size = sheet.charts[chart].size_mm;
  const auto across = static_cast<int>(std::lround(size.x() / kLineMm));
  const auto along = static_cast<int>(std::lround(size.y() / kLineMm));
  std::vector<TexturedMesh::Corner> corners;
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i <= across; ++i)
      corners.push_back({mesh.add_vertex(origin + kLineMm * (i * right + j * up)),
                         mesh.add_uv(sheet.uv(chart, {kLineMm * i, kLineMm * j}))});
  const auto at = [&](int i, int j) { return corners[j * (across + 1) + i]; };
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < across; ++i)
      mesh.add_face({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
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
  const auto corner = [](int i) {
    return Eigen::Vector3d(((i & 1) != 0 ? 0.5 : -0.5) * kSideMm,
                           ((i & 2) != 0 ? 0.5 : -0.5) * kSideMm, (i & 4) != 0 ? kThickMm : 0);
  };
  // Top, bottom (which is dipped first), then the four side faces. Each entry lists the lower left
  // corner as seen from outside, then the corners to the right of it and above it.
  const std::array<std::array<int, 3>, 6> sides = {
      {{4, 5, 6}, {1, 0, 3}, {0, 1, 4}, {1, 3, 5}, {3, 2, 7}, {2, 0, 6}}};
  for (std::size_t q = 0; q < sides.size(); ++q) {
    const Eigen::Vector3d origin = corner(sides[q][0]);
    add_side(sample.mesh, origin, (corner(sides[q][1]) - origin).normalized(),
             (corner(sides[q][2]) - origin).normalized(), q, sheet);
  }
  sample.texture = sheet.draw();
  sample.px_per_mm = sheet.px_per_mm;
  return sample;
}

}  // namespace hydroprint::sample
