#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "sim/base/result.h"

namespace hydroprint::ink {

/// Tells how much ink the printer lays down for some pixels: from `count` times R G B (8-bit sRGB)
/// t = C + M + Y + K of each, in [0, 4] (section 4.3). May be called from several threads at once.
using Separation = std::function<void(const std::uint8_t* rgb, std::size_t count, double* t)>;

/// Naive CMYK if no profile is named: K = 1 - max(R, G, B), the rest of the colour in C, M and Y.
/// Else that of the printer's ICC output profile by Little CMS, from sRGB, relative colorimetric,
/// without black point compensation.
/// Refuses, naming the file: one that is missing or cannot be read; profiles of other devices and
/// colour spaces (kInvalidArgument); damaged ones (kDataLoss); more than 64 MiB (kOutOfRange).
[[nodiscard]] Result<Separation> make_separation(const std::filesystem::path& icc_profile);

}  // namespace hydroprint::ink
