#include "sim/print/page_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/text/missing_glyphs.h"

namespace hydroprint::print {
namespace {

using Eigen::Vector2d;

constexpr double kAround_mm = 0.5;  ///< free space on each side of a block
constexpr double kLineStep = 2.8;   ///< distance between baselines, in heights of a lower-case x
/// Minimum width of a shortened block, in heights of a lower-case x.
constexpr double kLeastWidth = 12;
constexpr int kBisections = 12;

/// Lines laid out one below the other, with the first baseline starting at (0, 0); in heights of a
/// lower-case x.
struct Lines {
  std::vector<std::string> texts;
  Vector2d low = Vector2d::Zero(), high = Vector2d::Zero();
};

Lines laid_out(const text::Font& font, std::vector<std::string> texts) {
  Lines out;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const text::Line line = font.lay_out(texts[i]);
    const Vector2d at(0, -kLineStep * static_cast<double>(i));
    out.low = out.low.cwiseMin(at + line.low);
    out.high = out.high.cwiseMax(at + line.high);
  }
  out.texts = std::move(texts);
  return out;
}

std::optional<TextBlock> place(const Lines& lines, double letter_mm, const FindRoom& find_room) {
  const Vector2d around = Vector2d::Constant(kAround_mm);
  const auto box = find_room((lines.high - lines.low) * letter_mm + 2 * around);
  if (!box) return std::nullopt;
  TextBlock out{*box, {}, false};
  Vector2d at = box->low_mm + around - lines.low * letter_mm;
  for (const std::string& text : lines.texts) {
    if (!text.empty()) out.texts.push_back({text, at, letter_mm, 1});
    at.y() -= kLineStep * letter_mm;
  }
  return out;
}

}  // namespace

std::optional<TextBlock> place_text(const text::Font& font, const LinesOfWidth& lines,
                                    const FindRoom& find_room) {
  const Lines whole = laid_out(font, lines(HUGE_VAL));
  for (const double letter_mm : {kLetter_mm, 1.2, kSmallestLetter_mm}) {
    if (auto block = place(whole, letter_mm, find_room)) return block;
  }
  std::optional<TextBlock> best;
  double low = kLeastWidth, high = whole.high.x() - whole.low.x();
  for (int i = 0; i < kBisections && low <= high; ++i) {
    const double width = i == 0 ? low : (low + high) / 2;
    auto block = place(laid_out(font, lines(width)), kSmallestLetter_mm, find_room);
    (block ? low : high) = width;
    if (block) best = std::move(block);
    if (!best) return std::nullopt;
  }
  if (best) best->is_shortened = true;
  return best;
}

Box text_box(const text::Font& font, const Text& text) {
  const text::Line line = font.lay_out(text.text);
  return {text.at_mm + text.x_height_mm * line.low, text.at_mm + text.x_height_mm * line.high};
}

void warn_of_missing_glyphs(const text::Font& font, const std::vector<Text>& texts,
                            const Place& where, Warnings& warnings) {
  std::vector<char32_t> missing;
  for (const Text& text : texts) {
    for (const char32_t c : font.lay_out(text.text).missing) {
      if (std::find(missing.begin(), missing.end(), c) == missing.end()) missing.push_back(c);
    }
  }
  if (!missing.empty()) warnings.push_back(text::missing_glyphs_warning(missing, where));
}

void warn_of_shortened_text(const Place& where, Warnings& warnings) {
  warnings.push_back({WarningCode::TEXT_SHORTENED,
                      "the text is too long for the paper and ends in an ellipsis. Use a shorter "
                      "job name or larger paper",
                      where});
}

}  // namespace hydroprint::print
