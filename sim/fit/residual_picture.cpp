#include "sim/fit/residual_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "sim/image/figures/strokes.h"
#include "sim/image/figures/text.h"
#include "sim/text/font.h"

namespace hydroprint::fit {
namespace {

using Eigen::Vector2d;
using image::Rgb8;
using image::RgbImage;

constexpr double kPanel_px = 760;  ///< length of the film's longer side
constexpr double kGap_px = 30;
constexpr double kTitle_px = 60;
constexpr double kLetter_px = 12;
constexpr double kArrow_px = 40;  ///< maximum 95th percentile of the arrows' lengths
constexpr Rgb8 kInk = {40, 40, 40};
constexpr Rgb8 kBlue = {0, 90, 181};
constexpr Rgb8 kRed = {200, 30, 30};
constexpr Rgb8 kGrey = {170, 170, 170};

/// One of the two pictures and its place.
struct Panel {
  std::string name;
  double rms_mm = 0;
  Vector2d PointResult::*predicted;
  Vector2d corner_px = Vector2d::Zero();  ///< top left corner of the film's bounding box
};

struct Scale {
  Vector2d low_mm, size_mm;
  double px_per_mm;

  [[nodiscard]] Vector2d at(const Panel& panel, const Vector2d& film_mm) const {
    const Vector2d p = (film_mm - low_mm) * px_per_mm;
    return panel.corner_px + Vector2d(p.x(), size_mm.y() * px_per_mm - p.y());
  }
};

/// Returns 1, 2 or 5 times a power of ten, at least 1: the largest factor for which 95 % of the
/// arrows are at most kArrow_px long.
double enlargement(const Outcome& outcome, const Panel& panel, double px_per_mm) {
  std::vector<double> lengths;
  for (const PointResult& p : outcome.points) {
    const double length_mm = (p.*panel.predicted - p.point.film_mm).norm();
    if (p.is_used() && std::isfinite(length_mm)) lengths.push_back(length_mm);
  }
  if (lengths.empty()) return 1;
  std::sort(lengths.begin(), lengths.end());
  const double long_mm = lengths[19 * (lengths.size() - 1) / 20];
  const double most = kArrow_px / (px_per_mm * std::max(long_mm, 1e-6));
  const double ten = std::pow(10, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * ten <= most) return std::max(1.0, factor * ten);
  }
  return std::max(1.0, ten);
}

void draw_arrow(RgbImage& image, const Vector2d& from, const Vector2d& to, const Rgb8& colour) {
  image::draw_line(image, from, to, 1.6, colour);
  const Vector2d along = to - from;
  const double length = along.norm();
  if (!(length > 4)) return;
  const Vector2d back = along * (-5 / length);
  const Vector2d side(-0.5 * back.y(), 0.5 * back.x());
  image::draw_line(image, to, to + back + side, 1.6, colour);
  image::draw_line(image, to, to + back - side, 1.6, colour);
}

void draw_panel(RgbImage& image, const text::Font& font, const film::Outline& outline,
                const Outcome& outcome, const Panel& panel, const Scale& scale) {
  const std::vector<Vector2d>& polygon = outline.polygon;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    image::draw_line(image, scale.at(panel, polygon[i]),
                     scale.at(panel, polygon[(i + 1) % polygon.size()]), 2, kInk);
  }
  const double factor = enlargement(outcome, panel, scale.px_per_mm);
  for (const PointResult& p : outcome.points) {
    const Vector2d at = scale.at(panel, p.point.film_mm);
    const Rgb8& colour = p.is_outlier ? kRed : kBlue;
    image::draw_line(image, at, at, 4, p.is_used() ? colour : kGrey);
    if (!p.is_used()) continue;
    const Vector2d end = p.point.film_mm + factor * (p.*panel.predicted - p.point.film_mm);
    draw_arrow(image, at, scale.at(panel, end), colour);
  }
  const std::string title = fmt::format("{}  rms {:.3f} mm  arrows enlarged {:.0f} times",
                                        panel.name, panel.rms_mm, factor);
  image::draw_text(image, font, panel.corner_px.x(), panel.corner_px.y() - kLetter_px, kLetter_px,
                   title, kInk);
}

}  // namespace

Result<RgbImage> residual_picture(const film::Outline& outline, const Outcome& outcome) {
  HP_ASSIGN_OR_RETURN(const text::Font* const font, text::Font::standard());
  const Vector2d size_mm = outline.size_mm();
  const Scale scale{outline.min_mm, size_mm, kPanel_px / size_mm.maxCoeff()};
  // Titles need some room even above a narrow film.
  const double width_px = std::max(size_mm.x() * scale.px_per_mm, 0.9 * kPanel_px);
  const auto width = static_cast<int>(2 * width_px + 3 * kGap_px);
  const auto height = static_cast<int>(size_mm.y() * scale.px_per_mm + kTitle_px + kGap_px);
  RgbImage image{width, height,
                 std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * height, 255)};
  const std::array<Panel, 2> panels = {
      {{"before", outcome.rms_before_mm, &PointResult::before_mm, {kGap_px, kTitle_px}},
       {"after",
        outcome.rms_after_mm,
        &PointResult::after_mm,
        {2 * kGap_px + width_px, kTitle_px}}}};
  for (const Panel& panel : panels) draw_panel(image, *font, outline, outcome, panel, scale);
  return image;
}

}  // namespace hydroprint::fit
