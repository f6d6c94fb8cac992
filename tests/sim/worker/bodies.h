#pragma once

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

namespace hydroprint::worker {

/// A closed sphere with texture coordinates, as an OBJ file: `rings` bands, each with twice as many
/// faces as there are bands.
/// @param colour  red, green and blue of each vertex: "0.2 0.6 0.4"; empty: none
inline std::string sphere_obj(double radius_mm, int rings, const std::string& colour = "") {
  std::ostringstream vertices, uvs, faces;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    const double polar_rad = std::numbers::pi * i / rings;
    for (int j = 0; j <= around; ++j) {
      const double turn_rad = 2 * std::numbers::pi * (j % around) / around;
      const double r = i == 0 || i == rings ? 0 : radius_mm * std::sin(polar_rad);
      vertices << "v " << r * std::cos(turn_rad) << ' ' << r * std::sin(turn_rad) << ' '
               << -radius_mm * std::cos(polar_rad) << ' ' << colour << '\n';
      uvs << "vt " << 1.0 * j / around << ' ' << 1.0 * i / rings << '\n';
    }
  }
  const auto corner = [&](int i, int j) {
    const int index = i * (around + 1) + j + 1;
    faces << ' ' << index << '/' << index;
  };
  const auto face = [&](int i0, int j0, int i1, int j1, int i2, int j2) {
    faces << 'f';
    corner(i0, j0);
    corner(i1, j1);
    corner(i2, j2);
    faces << '\n';
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      if (i > 0) face(i, j, i, j + 1, i + 1, j + 1);
      if (i < rings - 1) face(i, j, i + 1, j + 1, i + 1, j);
    }
  }
  return vertices.str() + uvs.str() + faces.str();
}

}  // namespace hydroprint::worker
