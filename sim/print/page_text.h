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

/// Lines of text that were placed on a page.
struct TextBlock {
  Box box;  ///< holds all of their ink and some room around it
  std::vector<Text> texts;
  bool is_shortened = false;
};

/// The lines of a block that may be at most `width` wide (heights of a lower-case x); HUGE_VAL:
/// unshortened.
using LinesOfWidth = std::function<std::vector<std::string>(double width)>;
/// Finds room for a block of a size, if there is any.
using FindRoom = std::function<std::optional<Box>(const Eigen::Vector2d& size_mm)>;

/// Places lines of text one below the other, as large as there is room for, from 1.6 mm to 0.9 mm
/// height of a lower-case x; if there is none, shortened so far that there is; nullopt if little
/// would be left of them.
[[nodiscard]] std::optional<TextBlock> place_text(const text::Font& font, const LinesOfWidth& lines,
                                                  const FindRoom& find_room);

/// The box round a text's ink and its baseline, on the page.
[[nodiscard]] Box text_box(const text::Font& font, const Text& text);

/// Warns (text_glyph_missing) of characters of the texts that the font cannot draw.
void warn_of_missing_glyphs(const text::Font& font, const std::vector<Text>& texts,
                            const std::string& where, Warnings& warnings);

/// Warns (text_shortened) that the text was too long for the paper.
void warn_of_shortened_text(const std::string& where, Warnings& warnings);

/// Height of a lower-case x of most texts, and of the smallest.
inline constexpr double kLetter_mm = 1.6, kSmallestLetter_mm = 0.9;

}  // namespace hydroprint::print
