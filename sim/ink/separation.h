#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "sim/base/result.h"

namespace hydroprint::ink {

/// Computes the amount of ink t = C + M + Y + K, in [0, 4] (section 4.3), for each of `count`
/// pixels (R G B, 8-bit sRGB). May be called from several threads at once.
using Separation = std::function<void(const std::uint8_t* rgb, std::size_t count, double* t)>;

/// Returns the separation of a printer. Without a profile, naive CMYK: K = 1 - max(R, G, B), the
/// rest of the colour in C, M and Y. With a profile: Little CMS, from sRGB, relative colorimetric,
/// without black point compensation. Errors name the file: kNotFound or kPermissionDenied if it
/// cannot be read; kInvalidArgument for profiles of other devices and colour spaces; kDataLoss for
/// damaged profiles; kOutOfRange for more than 64 MiB.
[[nodiscard]] Result<Separation> make_separation(const std::filesystem::path& icc_profile);

}  // namespace hydroprint::ink
