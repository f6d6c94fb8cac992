#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::ink::testing {

/// What a made-up CMYK printer's profile says: each of C, M, Y and K gets share * (1 - L* / 100) of
/// ink, by rendering intent.
struct Printer {
  double perceptual = 0.25, colorimetric = 0.75;
};

/// An ICC profile (version 4) of that printer, as the bytes of a file.
[[nodiscard]] std::string icc_profile(const Printer& printer);

/// sRGB's own profile (a display, RGB), a CMYK profile that is no printer's, and one of a printer
/// that takes RGB.
[[nodiscard]] std::string srgb_profile();
[[nodiscard]] std::string cmyk_link_profile();
[[nodiscard]] std::string rgb_printer_profile();

}  // namespace hydroprint::ink::testing
