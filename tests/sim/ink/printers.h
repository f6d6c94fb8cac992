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

/// The profile of sRGB (a display, RGB), a CMYK profile that does not belong to a printer, and the
/// profile of an RGB printer.
[[nodiscard]] std::string srgb_profile();
[[nodiscard]] std::string cmyk_link_profile();
[[nodiscard]] std::string rgb_printer_profile();

}  // namespace hydroprint::ink::testing
