#include "sim/sheet/thickness.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/base/check.h"
#include "sim/velocity/quadratic_elements.h"

namespace hydroprint::sheet {
namespace {

using Eigen::Vector2d;

/// Limit of the area ratio in both directions. Beyond it, film has wrinkled (if compressed) or torn
/// (if stretched), and the sheet model is not valid.
constexpr double kMostAreaRatio = 5;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns twice the area of a triangle whose edges are parabolas through the corners and edge
/// midpoints (opposite corners 0, 1, 2). At rest a triangle of film has curved edges.
double twice_area(const std::array<Vector2d, 6>& node) {
  double area = cross(node[1] - node[0], node[2] - node[0]);
  for (int i = 0; i < 3; ++i) {
    const Vector2d& from = node[(i + 1) % 3];
    const Vector2d& to = node[(i + 2) % 3];
    area += 4.0 / 3 * cross(node[3 + i] - 0.5 * (from + to), to - from);
  }
  return area;
}

/// Returns the mean thickness at rest over a triangle with curved edges. Large triangles are
/// divided into quarters, which follow the curves better.
double mean_thickness_mm(const std::array<Vector2d, 6>& node, double twice_area_mm2,
                         const RestThickness& rest_thickness) {
  constexpr double kLarge_mm2 = 8;
  if (std::abs(twice_area_mm2) < kLarge_mm2) return rest_thickness({node[0], node[1], node[2]});
  constexpr std::array<std::array<int, 3>, 4> kQuarters = {
      {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}, {3, 4, 5}}};
  const auto area_of = [&](const std::array<int, 3>& quarter) {
    const auto& [a, b, c] = quarter;
    return cross(node[b] - node[a], node[c] - node[a]);
  };
  double area = 0;
  for (const auto& quarter : kQuarters) area += area_of(quarter);
  const bool is_folded = !(area > 0.5 * twice_area_mm2 && area < 2 * twice_area_mm2);
  if (is_folded) return rest_thickness({node[0], node[1], node[2]});
  double volume = 0;
  for (const auto& quarter : kQuarters) {
    const auto& [a, b, c] = quarter;
    volume += area_of(quarter) * rest_thickness({node[a], node[b], node[c]});
  }
  return volume / area;
}

/// Returns whether a triangle of film is torn or folded. The stretch is the inverse of that of the
/// linear map from the triangle to its corners at rest.
bool is_torn(const std::array<Vector2d, 6>& rest, const std::array<Vector2d, 3>& corner,
             double tear_stretch) {
  Eigen::Matrix2d now, before;
  now << corner[1] - corner[0], corner[2] - corner[0];
  before << rest[1] - rest[0], rest[2] - rest[0];
  const Eigen::Matrix2d to_rest = before * now.inverse();
  // The smaller singular value of a 2 x 2 matrix, from the norms of its two conformal parts.
  const double a = to_rest(0, 0), b = to_rest(0, 1), c = to_rest(1, 0), d = to_rest(1, 1);
  const double least = 0.5 * (std::hypot(a + d, c - b) - std::hypot(a - d, c + b));
  return !(least * tear_stretch >= 1);
}

}  // namespace

FloatingFilm floating_film(const flow::DipField& dip, std::size_t k,
                           const RestThickness& rest_thickness, double tear_stretch,
                           const flow::RestMap* known) {
  HP_CHECK(k < dip.fields.size());
  const velocity::FilmMesh& mesh = dip.fields[k].mesh();
  const std::vector<Vector2d> rest = flow::trace_back(dip, k, known);
  FloatingFilm out{std::vector<double>(mesh.triangles.size(), 0),
                   std::vector<char>(mesh.triangles.size(), 0)};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vector2d, 6> node;
    const auto nodes = velocity::nodes_of(mesh, t);
    const std::array<Vector2d, 3> corner = {velocity::place_of(mesh, nodes[0]),
                                            velocity::place_of(mesh, nodes[1]),
                                            velocity::place_of(mesh, nodes[2])};
    std::transform(nodes.begin(), nodes.end(), node.begin(), [&](int n) { return rest[n]; });
    const double rest_area = twice_area(node);
    double ratio = rest_area / velocity::twice_area_mm2(mesh, t);
    if (std::isnan(ratio)) ratio = 1;
    out.thickness_mm[t] = std::clamp(ratio, 1 / kMostAreaRatio, kMostAreaRatio) *
                          mean_thickness_mm(node, rest_area, rest_thickness);
    out.is_torn[t] = is_torn(node, corner, tear_stretch) ? 1 : 0;
  }
  return out;
}

}  // namespace hydroprint::sheet
