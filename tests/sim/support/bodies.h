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
/// @param profile  points (radius, height) with the solid on the left; either from axis to axis
///                 (both ends then have radius 0), or a closed curve that stays off the axis
[[nodiscard]] mesh::Model turned(const std::vector<Eigen::Vector2d>& profile, int segments);

/// A cone on its tip. Its side rises at `slope_rad` from the water, and its top is level.
[[nodiscard]] mesh::Model cone(double slope_rad, double height_mm, int segments);

/// A cylinder with a flat bottom. Its rim is divided evenly into `segments`.
[[nodiscard]] mesh::Model cylinder(double radius_mm, double height_mm, int segments);

/// A cup with these inner and outer radii, height and thickness of its bottom, mouth up or down.
/// @param vent_mm  radius of a hole in the middle of its bottom; 0: none
[[nodiscard]] mesh::Model cup(double inner_mm, double outer_mm, double height_mm, double bottom_mm,
                              bool mouth_up, int segments, double vent_mm = 0);

/// A ring with a round cross-section that lies on the water.
[[nodiscard]] mesh::Model torus(double ring_mm, double tube_mm, int segments, int around);

/// A ridge along y of the given half-length. Its two sides rise at `slope_rad` from the water.
[[nodiscard]] mesh::Model wedge(double slope_rad, double height_mm, double half_length_mm);

/// Several models as one, with separate shells.
[[nodiscard]] mesh::Model together(const std::vector<mesh::Model>& models);

[[nodiscard]] mesh::Model moved(mesh::Model model, const Eigen::Vector3d& by_mm);

/// Turns a model around the x axis, which raises points with a positive y.
[[nodiscard]] mesh::Model tilted(mesh::Model model, double tilt_rad);

/// Turns every face over.
[[nodiscard]] mesh::Model inside_out(mesh::Model model);

/// The surface of a model, which must be valid.
[[nodiscard]] mesh::Surface surface_of(const mesh::Model& model, double max_edge_mm = 2);

/// A surface as a body whose lowest point touches the water; x and y are unchanged.
[[nodiscard]] waterline::Body body_of(const mesh::Surface& surface);
[[nodiscard]] waterline::Body body_of(const mesh::Model& model, double max_edge_mm = 2);

}  // namespace hydroprint::testing
