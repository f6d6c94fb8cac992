#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "sim/film/outline.h"
#include "sim/velocity/film_mesh.h"
#include "sim/velocity/quadratic_elements.h"
#include "sim/waterline/cross_section.h"
#include "sim/waterline/waterlines.h"

namespace hydroprint::velocity::testing {

using Curve = std::vector<Eigen::Vector2d>;

/// A closed curve, given by its radius as a function of the angle around a centre.
template <class Radius>
Curve curve_round(const Eigen::Vector2d& centre_mm, int corners, Radius radius_mm) {
  Curve curve;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    curve.emplace_back(centre_mm +
                       radius_mm(angle) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return curve;
}

inline Curve circle(const Eigen::Vector2d& centre_mm, double radius_mm, int corners) {
  return curve_round(centre_mm, corners, [&](double) { return radius_mm; });
}

/// A smooth curve without symmetry.
inline Curve bean(const Eigen::Vector2d& centre_mm, double radius_mm) {
  return curve_round(centre_mm, 400, [&](double angle) {
    return radius_mm *
           (1 + 0.25 * std::cos(angle) + 0.15 * std::sin(2 * angle) + 0.05 * std::cos(5 * angle));
  });
}

/// The waterline of separate solids in the film, each of which pulls with unit speed towards its
/// middle.
inline waterline::Waterline line_round(const std::vector<Curve>& solids) {
  waterline::Waterline line;
  line.immersion_mm = 1;
  std::vector<waterline::Contour> contours;
  for (const Curve& solid : solids) {
    line.section.push_back({solid, false, -1});
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (const auto& p : solid) centre += p / static_cast<double>(solid.size());
    waterline::Contour contour;
    for (std::size_t i = 0; i < solid.size(); ++i) {
      const Eigen::Vector2d& a = solid[i];
      const Eigen::Vector2d& b = solid[(i + 1) % solid.size()];
      contour.push_back({a, b, (centre - a).normalized(), (centre - b).normalized()});
    }
    contours.push_back(contour);
  }
  line.bounds_film.assign(line.section.size(), 1);
  line.pulls = waterline::PullIndex(contours);
  return line;
}

inline double area_of(const FilmMesh& mesh, std::size_t triangle) {
  const Eigen::Vector3i& t = mesh.triangles[triangle];
  const Eigen::Vector2d u = mesh.vertices_mm[t[1]] - mesh.vertices_mm[t[0]];
  const Eigen::Vector2d v = mesh.vertices_mm[t[2]] - mesh.vertices_mm[t[0]];
  return 0.5 * (u.x() * v.y() - u.y() * v.x());
}

inline double distance_to(const Curve& curve, const Eigen::Vector2d& p) {
  double least = 1e300;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Eigen::Vector2d& a = curve[i];
    const Eigen::Vector2d along = curve[(i + 1) % curve.size()] - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + t * along - p).norm());
  }
  return least;
}

using Function = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

inline film::Outline outline_of(const std::string& text) {
  return film::parse_outline(text).value();
}

/// A function's values at the nodes on the film's edges; NaN at all other nodes.
inline std::vector<Eigen::Vector2d> prescribed(const FilmMesh& mesh, const Function& f) {
  std::vector<Eigen::Vector2d> fixed(
      mesh.node_count(), Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  const std::size_t vertices = mesh.vertices_mm.size();
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edge_kind[e] == EdgeKind::kInner) continue;
    fixed[vertices + e] = f(place_of(mesh, vertices + e));
    for (const int v : mesh.edges[e]) fixed[v] = f(mesh.vertices_mm[v]);
  }
  return fixed;
}

/// The mesh of a film with a bean and a quadrilateral in it. No two triangles are alike.
inline FilmMesh irregular_mesh() {
  return mesh_film(outline_of("100x80"),
                   line_round({bean({-12, 5}, 15), {{15, -20}, {30, -22}, {33, -5}, {20, -12}}}),
                   {})
      .value();
}

}  // namespace hydroprint::velocity::testing
