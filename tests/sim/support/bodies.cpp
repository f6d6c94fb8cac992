#include "tests/sim/support/bodies.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <numbers>
#include <utility>

#include "sim/mesh/make_surface.h"

namespace hydroprint::testing {

using Eigen::Vector2d;
using Eigen::Vector3d;

mesh::Model box(const Vector3d& low, const Vector3d& high) {
  return blocks({low.x(), high.x()}, {low.y(), high.y()}, {low.z(), high.z()},
                [](int, int, int) { return true; });
}

mesh::Model blocks(const std::vector<double>& x, const std::vector<double>& y,
                   const std::vector<double>& z,
                   const std::function<bool(int i, int j, int k)>& is_solid) {
  const std::array<const std::vector<double>*, 3> planes = {&x, &y, &z};
  const auto solid = [&](const std::array<int, 3>& cell) {
    for (int axis = 0; axis < 3; ++axis) {
      if (cell[axis] < 0 || cell[axis] + 1 >= static_cast<int>(planes[axis]->size())) return false;
    }
    return is_solid(cell[0], cell[1], cell[2]);
  };
  mesh::Model model;
  model.path = "blocks";
  std::map<std::array<int, 3>, int> index;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [it, is_new] = index.try_emplace(at, static_cast<int>(model.vertices.size()));
    if (is_new) model.vertices.emplace_back(x[at[0]], y[at[1]], z[at[2]]);
    return it->second;
  };
  // One face between a solid cell and an empty one, seen counter-clockwise from the empty one.
  const auto face = [&](std::array<int, 3> corner, int axis, bool towards_plus) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    corner[axis] += towards_plus;
    std::array<int, 4> quad{};
    for (int i = 0; i < 4; ++i) {
      std::array<int, 3> at = corner;
      at[u] += i == 1 || i == 2;
      at[v] += i >= 2;
      quad[towards_plus ? i : 3 - i] = vertex(at);
    }
    model.triangles.emplace_back(quad[0], quad[1], quad[2]);
    model.triangles.emplace_back(quad[0], quad[2], quad[3]);
  };
  for (int i = 0; i + 1 < static_cast<int>(x.size()); ++i) {
    for (int j = 0; j + 1 < static_cast<int>(y.size()); ++j) {
      for (int k = 0; k + 1 < static_cast<int>(z.size()); ++k) {
        if (!solid({i, j, k})) continue;
        for (int axis = 0; axis < 3; ++axis) {
          for (const int step : {-1, 1}) {
            std::array<int, 3> next = {i, j, k};
            next[axis] += step;
            if (!solid(next)) face({i, j, k}, axis, step > 0);
          }
        }
      }
    }
  }
  return model;
}

mesh::Model turned(const std::vector<Vector2d>& profile, int segments) {
  mesh::Model model;
  model.path = "turned";
  std::vector<std::vector<int>> rings;
  for (const Vector2d& p : profile) {
    std::vector<int> ring;
    for (int s = 0; s < segments; ++s) {
      if (p.x() > 0 || s == 0) {
        const double angle = 2 * std::numbers::pi * s / segments;
        ring.push_back(static_cast<int>(model.vertices.size()));
        model.vertices.emplace_back(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
      } else {
        ring.push_back(ring.front());
      }
    }
    rings.push_back(ring);
  }
  const bool is_closed = profile.front().x() > 0 && profile.back().x() > 0;
  const std::size_t bands = is_closed ? rings.size() : rings.size() - 1;
  for (std::size_t b = 0; b < bands; ++b) {
    const auto& low = rings[b];
    const auto& high = rings[(b + 1) % rings.size()];
    for (int s = 0; s < segments; ++s) {
      const int t = (s + 1) % segments;
      if (low[s] != low[t]) model.triangles.emplace_back(low[s], low[t], high[t]);
      if (high[s] != high[t]) model.triangles.emplace_back(low[s], high[t], high[s]);
    }
  }
  return model;
}

mesh::Model cone(double slope_rad, double height_mm, int segments) {
  const double radius_mm = height_mm / std::tan(slope_rad);
  return turned({{0, 0}, {radius_mm, height_mm}, {0, height_mm}}, segments);
}

mesh::Model cylinder(double radius_mm, double height_mm, int segments) {
  return turned({{0, 0}, {radius_mm, 0}, {radius_mm, height_mm}, {0, height_mm}}, segments);
}

mesh::Model cup(double inner_mm, double outer_mm, double height_mm, double bottom_mm, bool mouth_up,
                int segments, double vent_mm) {
  if (mouth_up) {
    return turned({{vent_mm, 0},
                   {outer_mm, 0},
                   {outer_mm, height_mm},
                   {inner_mm, height_mm},
                   {inner_mm, bottom_mm},
                   {vent_mm, bottom_mm}},
                  segments);
  }
  const double ceiling_mm = height_mm - bottom_mm;
  return turned({{vent_mm, ceiling_mm},
                 {inner_mm, ceiling_mm},
                 {inner_mm, 0},
                 {outer_mm, 0},
                 {outer_mm, height_mm},
                 {vent_mm, height_mm}},
                segments);
}

mesh::Model torus(double ring_mm, double tube_mm, int segments, int around) {
  std::vector<Vector2d> profile;
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / around;
    profile.emplace_back(ring_mm + tube_mm * std::cos(angle), tube_mm * std::sin(angle));
  }
  return turned(profile, segments);
}

mesh::Model wedge(double slope_rad, double height_mm, double half_length_mm) {
  const double half_width_mm = height_mm / std::tan(slope_rad);
  mesh::Model model;
  model.path = "wedge";
  for (const double y : {-half_length_mm, half_length_mm}) {
    model.vertices.emplace_back(0, y, 0);
    model.vertices.emplace_back(half_width_mm, y, height_mm);
    model.vertices.emplace_back(-half_width_mm, y, height_mm);
  }
  model.triangles = {{0, 1, 2}, {3, 5, 4}};
  for (const auto& [a, b] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 0}}) {
    model.triangles.emplace_back(a, a + 3, b);
    model.triangles.emplace_back(b, a + 3, b + 3);
  }
  return model;
}

mesh::Model together(const std::vector<mesh::Model>& models) {
  mesh::Model all;
  all.path = "together";
  for (const mesh::Model& model : models) {
    const int shift = static_cast<int>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), model.vertices.begin(), model.vertices.end());
    for (const auto& t : model.triangles) {
      all.triangles.push_back(t + Eigen::Vector3i::Constant(shift));
    }
  }
  return all;
}

mesh::Model moved(mesh::Model model, const Vector3d& by_mm) {
  for (Vector3d& v : model.vertices) v += by_mm;
  return model;
}

mesh::Model tilted(mesh::Model model, double tilt_rad) {
  const Eigen::AngleAxisd tilt(tilt_rad, Eigen::Vector3d::UnitX());
  for (Eigen::Vector3d& v : model.vertices) v = tilt * v;
  return model;
}

mesh::Model inside_out(mesh::Model model) {
  for (auto& t : model.triangles) std::swap(t[1], t[2]);
  return model;
}

mesh::Surface surface_of(const mesh::Model& model, double max_edge_mm) {
  auto surface = mesh::make_surface(model, max_edge_mm, {});
  if (!surface) {
    std::cerr << "surface_of: " << surface.error().message << '\n';
    std::abort();
  }
  return std::move(*surface);
}

waterline::Body body_of(const mesh::Surface& surface) {
  Pose X_FO = Pose::Identity();
  return waterline::place(surface, X_FO);
}

waterline::Body body_of(const mesh::Model& model, double max_edge_mm) {
  return body_of(surface_of(model, max_edge_mm));
}

}  // namespace hydroprint::testing
