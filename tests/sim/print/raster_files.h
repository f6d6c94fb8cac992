#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace hydroprint::print {

/// Pixels as rendered by other programs.
struct Raster {
  int width = 0, height = 0, channels = 0;
  std::vector<std::uint8_t> samples;

  [[nodiscard]] const std::uint8_t* at(int x, int y) const {
    return &samples[(static_cast<std::size_t>(y) * width + x) * channels];
  }
};

/// Reads a PGM, PPM or PAM with 8 bits; throws std::runtime_error for anything else.
[[nodiscard]] Raster read_netpbm(const std::filesystem::path& path);

/// A page of a PDF, rendered in grey by poppler.
[[nodiscard]] Raster drawn_by_poppler(const std::filesystem::path& pdf, int dpi, int page = 1);

/// A page of a PDF, or a TIFF, rendered by MuPDF with its amounts of ink unchanged.
[[nodiscard]] Raster inks_by_mupdf(const std::filesystem::path& file, int dpi, int page = 1);

/// The drawing operations of a PDF's pages, as text, by MuPDF.
[[nodiscard]] std::string traced_by_mupdf(const std::filesystem::path& pdf);

/// Numbers in a TIFF's first directory, by tag; rationals as quotients.
[[nodiscard]] std::map<int, double> tiff_tags(const std::filesystem::path& path);

/// Resolution of a PNG in pixels per metre, across and down.
struct PngResolution {
  std::uint32_t per_metre_x = 0, per_metre_y = 0;
};
[[nodiscard]] PngResolution png_resolution(const std::filesystem::path& path);

/// All bytes of a file.
[[nodiscard]] std::string bytes_of(const std::filesystem::path& path);

}  // namespace hydroprint::print
