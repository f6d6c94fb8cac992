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

/// A character on a line. Lengths are in heights of a lower-case x.
struct PlacedGlyph {
  char32_t character = 0;   ///< as drawn: U+FFFD in place of one that the font lacks
  std::uint32_t glyph = 0;  ///< its number in the font
  double left = 0;          ///< where it begins on the baseline
};

/// A line of text, its baseline from (0, 0) to the right, y up; lengths in heights of a lower-case
/// x.
struct Line {
  std::vector<PlacedGlyph> glyphs;
  double width = 0;
  /// Holds all ink and the baseline.
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();
  /// What is drawn as U+FFFD, each once, in the order of the text: characters that the font lacks,
  /// and U+FFFD itself for what decode_utf8() cannot decode.
  std::vector<char32_t> missing;
};

/// Pixels of one glyph: how much of each is covered, from 0 to 255; row 0 on top.
struct Coverage {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<std::uint8_t> samples;
};

/// What a PDF says about a font (ISO 32000-1, table 122), in thousandths of the em.
struct FontMetrics {
  std::string name;  ///< PostScript name: "DejaVuSans"
  double ascent = 0, descent = 0, capital_height = 0;
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();  ///< of all glyphs
};

/// A TrueType font. Glyphs stand one after the other by their advances; scripts that are written
/// from right to left or whose letters join are not supported. All functions may be called by
/// several threads at once and give the same results for any number of them: glyphs are not
/// hinted.
class Font {
 public:
  /// The font of pages and pictures (DejaVu Sans), loaded at its first use and kept. Fails as
  /// open() does.
  [[nodiscard]] static Result<const Font*> standard();

  /// Reads a font file. Fails (kInternal), naming the file and the Debian package, if it is
  /// missing, unreadable or not a scalable TrueType font with the letter x and U+FFFD.
  [[nodiscard]] static Result<Font> open(const std::filesystem::path& file);

  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;
  ~Font();

  /// Lays out UTF-8 on one line.
  [[nodiscard]] Line lay_out(std::string_view text) const;

  /// Returns the text if it is at most `width` heights of a lower-case x wide; else as much of its
  /// beginning as fits with an ellipsis (U+2026); empty if there is no room even for that.
  [[nodiscard]] std::string shortened(std::string_view text, double width) const;

  /// Draws a glyph whose origin is at a place of the picture, x to the right, y down.
  /// @param x_height_px  height of a lower-case x
  [[nodiscard]] Coverage rasterize(std::uint32_t glyph, const Eigen::Vector2d& origin_px,
                                   double x_height_px) const;

  /// How far a glyph moves the pen, in ems.
  [[nodiscard]] double advance_em(std::uint32_t glyph) const;
  /// Height of a lower-case x, in ems.
  [[nodiscard]] double x_height_em() const;
  [[nodiscard]] FontMetrics metrics() const;
  /// The bytes of the font file.
  [[nodiscard]] const std::string& file() const;

 private:
  struct Impl;
  explicit Font(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::text
