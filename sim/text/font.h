#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::text {

/// A glyph on a line. Lengths are in heights of a lower-case x.
struct PlacedGlyph {
  char32_t character = 0;   ///< drawn character: U+FFFD for one that the font lacks
  std::uint32_t glyph = 0;  ///< its index in the font
  double left = 0;          ///< its start on the baseline
};

/// A line of text with its baseline from (0, 0) to the right, y up. Lengths are in heights of a
/// lower-case x.
struct Line {
  std::vector<PlacedGlyph> glyphs;
  double width = 0;
  /// Bounding box of all ink and the baseline.
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();
  /// The characters that are drawn as U+FFFD, each once, in text order: those that the font lacks,
  /// and U+FFFD itself for bytes that decode_utf8() cannot decode.
  std::vector<char32_t> missing;
};

/// Coverage of each pixel of a glyph, 0 to 255; row 0 is the top row.
struct Coverage {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<std::uint8_t> samples;
};

/// Font properties for a PDF (ISO 32000-1, table 122), in thousandths of the em.
struct FontMetrics {
  std::string name;  ///< PostScript name: "DejaVuSans"
  double ascent = 0, descent = 0, capital_height = 0;
  /// Bounding box of all glyphs.
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();
};

/// A TrueType font. Glyphs are placed one after the other by their advances; right-to-left and
/// joining scripts are not supported. All functions are thread-safe. Results do not depend on the
/// number of threads, because glyphs are not hinted.
class Font {
 public:
  /// Returns the font of pages and pictures (DejaVu Sans), which is loaded on first use. Returns
  /// the errors of open().
  [[nodiscard]] static Result<const Font*> standard();

  /// Reads a font file. Returns kInternal, with the file and the Debian package, if it is missing,
  /// unreadable or not a scalable TrueType font with the letter x and U+FFFD.
  [[nodiscard]] static Result<Font> open(const std::filesystem::path& file);

  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;
  ~Font();

  /// Lays out UTF-8 on one line.
  [[nodiscard]] Line lay_out(std::string_view text) const;

  /// Shortens the text to a width in heights of a lower-case x. If the text is too wide, returns as
  /// much of its beginning as fits together with an ellipsis (U+2026); empty if the ellipsis alone
  /// is too wide.
  [[nodiscard]] std::string shortened(std::string_view text, double width) const;

  /// Rasterizes a glyph whose origin is at this position in the picture, x to the right, y down.
  /// @param x_height_px  height of a lower-case x
  [[nodiscard]] Coverage rasterize(std::uint32_t glyph, const Eigen::Vector2d& origin_px,
                                   double x_height_px) const;

  /// Returns the advance of a glyph, in ems.
  [[nodiscard]] double advance_em(std::uint32_t glyph) const;
  /// Returns the height of a lower-case x, in ems.
  [[nodiscard]] double x_height_em() const;
  [[nodiscard]] FontMetrics metrics() const;
  /// Returns the bytes of the font file.
  [[nodiscard]] const std::string& file() const;

 private:
  struct Impl;
  explicit Font(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::text
