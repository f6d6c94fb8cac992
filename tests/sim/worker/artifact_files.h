#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hydroprint::worker {

/// Contents of surface_map.ply. A vertex has x, y, z, film_x, film_y, contact_time, stretch,
/// stretch_min and error_mm.
struct Ply {
  std::string header;
  std::vector<std::array<double, 9>> vertices;
  std::vector<std::array<std::int32_t, 3>> faces;
  std::vector<std::uint8_t> flags;  ///< per face
};

/// Fails the test if the file's size does not match its header.
[[nodiscard]] Ply read_ply(const std::filesystem::path& path);

/// A vertex of landed.ply.
struct LandedVertex {
  std::array<double, 3> xyz;
  std::array<std::uint8_t, 4> rgb_landed;
};

[[nodiscard]] std::vector<LandedVertex> read_landed(const std::filesystem::path& path);

}  // namespace hydroprint::worker
