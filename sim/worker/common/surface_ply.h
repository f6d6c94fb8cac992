#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "sim/base/result.h"
#include "sim/flow/surface_map.h"
#include "sim/mesh/surface.h"
#include "sim/pipeline/plan.h"
#include "sim/scan/marching.h"

namespace hydroprint::worker {

/// Writes surface_map.ply: for each point, x, y, z (O, mm), film_x, film_y (F, mm), contact_time
/// (s), stretch, stretch_min and error_mm, as binary little-endian doubles, NaN where no film
/// arrives; then the triangles with their flags (pipeline::FaceFlag, uchar). Returns the errors of
/// image::write_artifact().
[[nodiscard]] Status write_surface_map(const std::filesystem::path& path,
                                       const mesh::Surface& surface, const flow::SurfaceMap& map,
                                       const std::vector<std::uint8_t>& face_flags);

/// Writes landed.ply: for each point, x, y, z (O, mm), red, green, blue and landed (1, or 0 where
/// no film arrives); then the triangles. Returns the errors of image::write_artifact().
/// @param colours  per point, sRGB-coded in [0, 1]; NaN where no film arrives, written as white
[[nodiscard]] Status write_landed(const std::filesystem::path& path, const mesh::Surface& surface,
                                  const std::vector<Eigen::Vector3f>& colours);

/// Writes plan.ply: for each point, x, y, z (O, mm), the dip to which it belongs (int, from 1; 0:
/// none), then for each dip its weight, then for each dip the stretch of its film under Stokes
/// flow, by which the surface is divided, then for each dip the smaller singular value of that
/// film's Jacobian (both NaN where no film arrives); then the triangles. Returns the errors of
/// image::write_artifact().
[[nodiscard]] Status write_plan(const std::filesystem::path& path, const pipeline::Plan& plan);

/// The surface of a plan, and the stretch by which it was divided.
struct PlanSurface {
  std::vector<Eigen::Vector3d> points;  ///< O, mm
  std::vector<Eigen::Vector3i> triangles;
  std::vector<std::vector<double>> stretch;  ///< per dip and point; NaN where no film arrives
};

/// Reads a file of write_plan(). Takes memory only for what the file holds. Returns the errors of
/// open_input_file(), and kInvalidArgument, naming the file and the remedy, for any other file and
/// for a plan with another number of dips.
[[nodiscard]] Result<PlanSurface> read_plan_surface(const std::filesystem::path& path,
                                                    std::size_t dips);

/// Writes a scan's surface: x, y, z (mm) for each point, then the triangles. Returns the errors of
/// image::write_artifact().
[[nodiscard]] Status write_scan(const std::filesystem::path& path, const scan::TriangleMesh& mesh);

}  // namespace hydroprint::worker
