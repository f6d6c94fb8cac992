#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::ink::testing {

/// The profile of a fictitious CMYK printer: each of C, M, Y and K gets the amount share * (1 - L*
/// / 100), with the share depending on the rendering intent.
struct Printer {
  double perceptual = 0.25, colorimetric = 0.75;
};

/// An ICC profile (version 4) of that printer, as the bytes of a file.
[[nodiscard]] std::string icc_profile(const Printer& printer);

/// Profiles that are not of a CMYK printer: sRGB (a display), a CMYK device link, and an RGB
/// printer.
[[nodiscard]] std::string srgb_profile();
[[nodiscard]] std::string cmyk_link_profile();
[[nodiscard]] std::string rgb_printer_profile();

}  // namespace hydroprint::ink::testing
