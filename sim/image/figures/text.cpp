#include "sim/image/figures/text.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "sim/image/figures/strokes.h"

namespace hydroprint::image {
namespace {

constexpr double kSpacing = 0.38;  ///< between letters, in heights of an x
constexpr double kSpaceWidth = 0.4;

/// One letter: poly-lines in units of the height of an x, baseline at 0, y up.
struct Glyph {
  std::vector<std::vector<Eigen::Vector2d>> strokes;
  double width = 0;

  Glyph& move(double x, double y) {
    strokes.push_back({{x, y}});
    width = std::max(width, x);
    return *this;
  }
  Glyph& line(double x, double y) {
    strokes.back().emplace_back(x, y);
    width = std::max(width, x);
    return *this;
  }
  /// An arc of an ellipse, degrees counter-clockwise from the right; continues the current stroke.
  Glyph& arc(double x, double y, double rx, double ry, double from_deg, double to_deg) {
    constexpr int kPieces = 16;
    for (int i = 0; i <= kPieces; ++i) {
      const double angle = (from_deg + (to_deg - from_deg) * i / kPieces) * M_PI / 180;
      line(x + rx * std::cos(angle), y + ry * std::sin(angle));
    }
    return *this;
  }
  Glyph& oval(double x, double y, double rx, double ry) {
    return move(x + rx, y).arc(x, y, rx, ry, 0, 360);
  }
  Glyph& bowl() { return oval(0.43, 0.5, 0.43, 0.5); }
  Glyph& stem(double x, double bottom, double top) { return move(x, bottom).line(x, top); }
};

std::map<char, Glyph> make_letters() {
  std::map<char, Glyph> g;
  g['a'].bowl().stem(0.86, 0, 1);
  g['b'].bowl().stem(0, 0, 1.5);
  g['c'].move(0.75, 0.83).arc(0.43, 0.5, 0.43, 0.5, 42, 318);
  g['d'].bowl().stem(0.86, 0, 1.5);
  g['e'].move(0.02, 0.52).line(0.86, 0.52).arc(0.43, 0.5, 0.43, 0.5, 3, 318);
  g['f'].move(0.62, 1.48).arc(0.54, 1.16, 0.34, 0.34, 75, 180).line(0.2, 0).stem(0.2, 0, 0);
  g['f'].move(0, 0.95).line(0.55, 0.95);
  g['g'].bowl().move(0.86, 1).line(0.86, -0.1).arc(0.44, -0.1, 0.42, 0.36, 0, -150);
  g['h'].stem(0, 0, 1.5).move(0, 0.6).arc(0.4, 0.6, 0.4, 0.4, 180, 0).line(0.8, 0);
  g['i'].stem(0, 0, 1).stem(0, 1.4, 1.42);
  g['j'].move(0.2, 1).line(0.2, -0.2).arc(0, -0.2, 0.2, 0.25, 0, -90).stem(0.2, 1.4, 1.42);
  g['k'].stem(0, 0, 1.5).move(0.7, 1).line(0, 0.38).move(0.26, 0.6).line(0.74, 0);
  g['l'].stem(0, 0, 1.5);
  g['m'].stem(0, 0, 1).move(0, 0.66).arc(0.34, 0.66, 0.34, 0.34, 180, 0).line(0.68, 0);
  g['m'].move(0.68, 0.66).arc(1.02, 0.66, 0.34, 0.34, 180, 0).line(1.36, 0);
  g['n'].stem(0, 0, 1).move(0, 0.6).arc(0.4, 0.6, 0.4, 0.4, 180, 0).line(0.8, 0);
  g['o'].bowl();
  g['p'].bowl().stem(0, -0.45, 1);
  g['q'].bowl().stem(0.86, -0.45, 1);
  g['r'].stem(0, 0, 1).move(0, 0.58).arc(0.42, 0.58, 0.42, 0.42, 180, 75);
  g['s'].move(0.68, 0.84).arc(0.38, 0.75, 0.34, 0.25, 35, 270);
  g['s'].arc(0.38, 0.25, 0.37, 0.25, 90, -150);
  g['t'].move(0.22, 1.35).line(0.22, 0.28).arc(0.5, 0.28, 0.28, 0.28, 180, 290);
  g['t'].move(0, 0.95).line(0.56, 0.95);
  g['u'].move(0, 1).line(0, 0.4).arc(0.4, 0.4, 0.4, 0.4, 180, 360).line(0.8, 1).stem(0.8, 0, 1);
  g['v'].move(0, 1).line(0.4, 0).line(0.8, 1);
  g['w'].move(0, 1).line(0.3, 0).line(0.6, 1).line(0.9, 0).line(1.2, 1);
  g['x'].move(0, 1).line(0.76, 0).move(0, 0).line(0.76, 1);
  g['y'].move(0, 1).line(0.42, 0).move(0.82, 1).line(0.24, -0.45);
  g['z'].move(0, 1).line(0.74, 1).line(0, 0).line(0.76, 0);
  g['0'].oval(0.43, 0.7, 0.43, 0.7);
  g['1'].move(0.08, 1.1).line(0.42, 1.4).line(0.42, 0);
  g['2'].move(0.04, 1.08).arc(0.43, 0.99, 0.4, 0.41, 165, -38).line(0, 0).line(0.86, 0);
  g['3'].move(0.1, 1.21).arc(0.42, 1.04, 0.37, 0.36, 150, -90);
  g['3'].arc(0.42, 0.34, 0.43, 0.34, 90, -150);
  g['4'].move(0.64, 0).line(0.64, 1.4).line(0, 0.42).line(0.88, 0.42);
  g['5'].move(0.78, 1.4).line(0.16, 1.4).line(0.1, 0.77).arc(0.42, 0.46, 0.43, 0.46, 138, -150);
  g['6'].oval(0.43, 0.44, 0.42, 0.44).move(0.01, 0.44).arc(0.78, 0.46, 0.77, 0.94, 180, 100);
  g['7'].move(0, 1.4).line(0.84, 1.4).line(0.28, 0);
  g['8'].oval(0.43, 1.05, 0.35, 0.35).oval(0.43, 0.35, 0.43, 0.35);
  g['9'].oval(0.43, 0.96, 0.42, 0.44).move(0.85, 0.96).arc(0.08, 0.94, 0.77, 0.94, 0, -80);
  g['.'].stem(0.05, 0, 0.02);
  g['-'].move(0.05, 0.5).line(0.55, 0.5);
  g['+'].move(0, 0.6).line(0.7, 0.6).stem(0.35, 0.25, 0.95);
  g['_'].move(0, 0).line(0.7, 0);
  g[':'].stem(0.05, 0.15, 0.17).stem(0.05, 0.85, 0.87);
  g['/'].move(0, -0.2).line(0.6, 1.5);
  g[','].move(0.12, 0.05).line(0, -0.25);
  g['#'].move(0, 0.45).line(0.9, 0.45).move(0, 0.95).line(0.9, 0.95);
  g['#'].move(0.2, 0).line(0.35, 1.4).move(0.55, 0).line(0.7, 1.4);
  g['('].move(0.3, 1.5).arc(0.6, 0.6, 0.6, 0.95, 120, 240);
  g[')'].move(0.05, 1.42).arc(-0.25, 0.6, 0.6, 0.95, 60, -60);
  return g;
}

const Glyph* glyph(char c) {
  static const std::map<char, Glyph> letters = make_letters();
  const auto found = letters.find(c);
  return found == letters.end() ? nullptr : &found->second;
}

/// Share of a pixel that a letter covers with ink, from 0 to 1.
double ink(const Glyph& letter, const Eigen::Vector2d& at, double size_px) {
  double nearest = HUGE_VAL;
  for (const auto& stroke : letter.strokes) {
    for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
      nearest = std::min(nearest, distance_to_segment(at, stroke[i], stroke[i + 1]));
    }
  }
  return std::clamp((0.5 * kPen - nearest) * size_px + 0.5, 0.0, 1.0);
}

void draw_letter(RgbImage& image, const Glyph& letter, double left_px, double baseline_px,
                 double size_px, const Rgb8& colour) {
  const int x0 = std::max(0, static_cast<int>(left_px - 0.3 * size_px));
  const int x1 =
      std::min(image.width, static_cast<int>(left_px + (letter.width + 0.3) * size_px) + 1);
  const int y0 = std::max(0, static_cast<int>(baseline_px - 1.8 * size_px));
  const int y1 = std::min(image.height, static_cast<int>(baseline_px + 0.7 * size_px) + 1);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const Eigen::Vector2d at((x + 0.5 - left_px) / size_px, (baseline_px - y - 0.5) / size_px);
      mix_in(image.at(x, y), colour, ink(letter, at, size_px));
    }
  }
}

}  // namespace

void draw_text(RgbImage& image, double left_px, double baseline_px, double size_px,
               std::string_view text, const Rgb8& colour) {
  for (const char c : text) {
    const Glyph* letter = glyph(c);
    if (letter) draw_letter(image, *letter, left_px, baseline_px, size_px, colour);
    left_px += ((letter ? letter->width : kSpaceWidth) + kSpacing) * size_px;
  }
}

std::vector<std::vector<Eigen::Vector2d>> text_strokes(std::string_view text) {
  std::vector<std::vector<Eigen::Vector2d>> out;
  double left = 0;
  for (const char c : text) {
    const Glyph* letter = glyph(c);
    for (std::size_t i = 0; letter != nullptr && i < letter->strokes.size(); ++i) {
      auto& stroke = out.emplace_back(letter->strokes[i]);
      for (Eigen::Vector2d& point : stroke) point.x() += left;
    }
    left += (letter ? letter->width : kSpaceWidth) + kSpacing;
  }
  return out;
}

double text_width_px(double size_px, std::string_view text) {
  double width = text.empty() ? 0 : -kSpacing;
  for (const char c : text) {
    const Glyph* letter = glyph(c);
    width += (letter ? letter->width : kSpaceWidth) + kSpacing;
  }
  return width * size_px;
}

}  // namespace hydroprint::image
