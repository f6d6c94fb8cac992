#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::mesh {

/// Brings sRGB-coded colours of a text file to [0, 1] in place. Formats mean 0 to 1, but files also
/// have 0 to 255 or 0 to 65535: the largest value decides for all (up to 1.5 counts as 1). Values
/// that are not numbers make a colour white. Each of these assumptions is a warning:
/// `COLOURS_SCALED`, `COLOURS_CLAMPED`, `COLOURS_NOT_NUMBERS`.
/// @param what  "vertices" or "materials", for the warnings
void bring_to_unit(std::vector<Eigen::Vector3f>& colours, std::string_view what,
                   const std::filesystem::path& path, Warnings& warnings);

/// Codes linear light as sRGB (IEC 61966-2-1), limited to [0, 1]. glTF's factors and vertex colours
/// are linear.
[[nodiscard]] float srgb_of_linear(double linear);

}  // namespace hydroprint::mesh
