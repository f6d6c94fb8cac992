#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "sim/image/io/colour.h"
#include "sim/image/layers/surface_paint.h"
#include "tests/sim/image/scenes.h"

namespace hydroprint::image::testing {

/// The box from -size/2 to size/2 with outward triangles, each side as n x n squares; no UVs.
inline mesh::Model box_model(const Eigen::Vector3d& size, int n = 8) {
  mesh::Model model;
  model.path = "box.stl";
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      const auto corner = [&](int i, int j) {
        Eigen::Vector3d p;
        p[axis] = side * size[axis] / 2;
        p[b] = (static_cast<double>(i) / n - 0.5) * size[b];
        p[c] = side * (static_cast<double>(j) / n - 0.5) * size[c];
        model.vertices.push_back(p);
        return static_cast<int>(model.vertices.size()) - 1;
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const int p = corner(i, j), q = corner(i + 1, j), r = corner(i + 1, j + 1),
                    s = corner(i, j + 1);
          model.triangles.emplace_back(p, q, r);
          model.triangles.emplace_back(p, r, s);
        }
      }
    }
  }
  return model;
}

/// Welds equal points, as make_surface() does.
inline mesh::Surface welded_surface(const mesh::Model& model) {
  mesh::Surface surface = surface_of(model);
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    for (std::size_t w = 0; w < v; ++w) {
      if ((surface.points[v] - surface.points[w]).norm() > 1e-9) continue;
      surface.weld[v] = static_cast<int>(w);
      break;
    }
  }
  return surface;
}

/// Returns sRGB codes of the paint at a point of a triangle, seen with a sample of 0.01 mm.
inline Eigen::Vector3d codes_at(const SurfacePaint& paint, const mesh::Surface& surface,
                                int triangle, const Eigen::Vector3d& barycentric) {
  const auto& t = surface.triangles[static_cast<std::size_t>(triangle)];
  std::array<Eigen::Vector3d, 3> p;
  for (int i = 0; i < 3; ++i) p[i] = surface.points[static_cast<std::size_t>(t[i])];
  const Eigen::Vector3d x = (p[1] - p[0]).normalized();
  const Eigen::Vector3d y = x.cross(p[2] - p[0]).cross(x).normalized();
  flow::MappedTriangle tile;
  tile.triangle = triangle;
  Corners at;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  for (int i = 0; i < 3; ++i) {
    tile.barycentric[i] = Eigen::Vector3f::Unit(i);
    at[i] = 100 * Eigen::Vector2d((p[i] - p[0]).dot(x), (p[i] - p[0]).dot(y));
    place += barycentric[i] * at[i];
  }
  const Eigen::Vector3f light = paint.brush(surface, tile, at).at(place.x(), place.y());
  Eigen::Vector3d codes;
  for (int c = 0; c < 3; ++c) codes[c] = 255 * static_cast<double>(srgb_from_linear(light)[c]);
  return codes;
}

}  // namespace hydroprint::image::testing
