#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "sim/base/result.h"
#include "sim/flow/surface_map.h"
#include "sim/mesh/surface.h"

namespace hydroprint::worker {

/// Writes surface_map.ply (contract): per point x, y, z (O, mm), film_x, film_y (F, mm),
/// contact_time (s), stretch, as binary little-endian doubles, NaN where no film arrives; then the
/// triangles. Fails as image::write_artifact does.
[[nodiscard]] Status write_surface_map(const std::filesystem::path& path,
                                       const mesh::Surface& surface, const flow::SurfaceMap& map);

/// What lands on one point of the surface: sRGB, and whether any film does.
struct Landed {
  std::array<std::uint8_t, 3> rgb = {255, 255, 255};
  bool landed = false;
};

/// Writes landed.ply: per point x, y, z, red, green, blue, landed (0 or 1); then the triangles.
[[nodiscard]] Status write_landed(const std::filesystem::path& path, const mesh::Surface& surface,
                                  const std::vector<Landed>& landed);

}  // namespace hydroprint::worker
