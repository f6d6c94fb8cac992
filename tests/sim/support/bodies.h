#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"
#include "sim/waterline/body.h"

namespace hydroprint::testing {

/// An axis-aligned box, closed, facing outward.
[[nodiscard]] mesh::Model box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// The solid cells of a grid as one closed surface: feet, shelves, rings, U-shapes.
/// @param x, y, z  planes of the grid, increasing; cell (i, j, k) lies between planes i and i + 1
[[nodiscard]] mesh::Model blocks(const std::vector<double>& x, const std::vector<double>& y,
                                 const std::vector<double>& z,
                                 const std::function<bool(int i, int j, int k)>& is_solid);

/// A profile rotated around the z axis, closed, facing outward.
/// @param profile  (radius, height), solid on its left; from axis to axis (its ends then have
///                 radius 0), or a closed curve that stays off the axis
[[nodiscard]] mesh::Model turned(const std::vector<Eigen::Vector2d>& profile, int segments);

/// A cone on its tip, its side at `slope_rad` to the water, closed by a level top.
[[nodiscard]] mesh::Model cone(double slope_rad, double height_mm, int segments);

/// A flat-bottomed cylinder, rim subdivided evenly.
[[nodiscard]] mesh::Model cylinder(double radius_mm, double height_mm, int segments);

/// A cup: inner and outer radius, height, thickness of its bottom; mouth up or down.
[[nodiscard]] mesh::Model cup(double inner_mm, double outer_mm, double height_mm, double bottom_mm,
                              bool mouth_up, int segments);

/// A ring with a round section lying on the water.
[[nodiscard]] mesh::Model torus(double ring_mm, double tube_mm, int segments, int around);

/// A ridge along y of the given half-length, its two sides at `slope_rad` to the water.
[[nodiscard]] mesh::Model wedge(double slope_rad, double height_mm, double half_length_mm);

/// Several models as one, with separate shells.
[[nodiscard]] mesh::Model together(const std::vector<mesh::Model>& models);

[[nodiscard]] mesh::Model moved(mesh::Model model, const Eigen::Vector3d& by_mm);

/// Turns every face over.
[[nodiscard]] mesh::Model inside_out(mesh::Model model);

/// The surface of a model; the model must have one.
[[nodiscard]] mesh::Surface surface_of(const mesh::Model& model, double max_edge_mm = 2);

/// The surface placed on the water according to its own coordinates (x and y unchanged).
[[nodiscard]] waterline::Body body_of(const mesh::Surface& surface);
[[nodiscard]] waterline::Body body_of(const mesh::Model& model, double max_edge_mm = 2);

}  // namespace hydroprint::testing
