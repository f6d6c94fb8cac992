#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/result.h"
#include "sim/print/free_space.h"
#include "sim/print/page.h"
#include "sim/text/font.h"

namespace hydroprint::print {

/// Lines of text placed on a page.
struct TextBlock {
  Box box;  ///< contains the ink of all lines and a margin
  std::vector<Text> texts;
  bool is_shortened = false;
};

/// Returns the lines of a block, shortened to at most `width` (in heights of a lower-case x);
/// HUGE_VAL: unshortened.
using LinesOfWidth = std::function<std::vector<std::string>(double width)>;
/// Finds free space of a given size; nullopt if there is none.
using FindRoom = std::function<std::optional<Box>(const Eigen::Vector2d& size_mm)>;

/// Places lines of text one below the other, at the largest size for which there is space, with a
/// lower-case x 1.6 mm to 0.9 mm high. If even the smallest size does not fit, the lines are
/// shortened. Returns nullopt if even a width of 12 times the height of a lower-case x does not
/// fit.
[[nodiscard]] std::optional<TextBlock> place_text(const text::Font& font, const LinesOfWidth& lines,
                                                  const FindRoom& find_room);

/// Returns the box around a text's ink and its baseline, on the page.
[[nodiscard]] Box text_box(const text::Font& font, const Text& text);

/// Adds the warning text_glyph_missing if the font cannot draw some characters of the texts.
void warn_of_missing_glyphs(const text::Font& font, const std::vector<Text>& texts,
                            const Place& where, Warnings& warnings);

/// Adds the warning text_shortened: the text is too long for the paper.
void warn_of_shortened_text(const Place& where, Warnings& warnings);

/// Height of a lower-case x in normal text, and in the smallest text.
inline constexpr double kLetter_mm = 1.6, kSmallestLetter_mm = 0.9;

}  // namespace hydroprint::print
