#include "sim/image/figures/strokes.h"

#include <algorithm>
#include <cmath>

namespace hydroprint::image {

using Eigen::Vector2d;

namespace {

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0;
  return (p - a - t * along).norm();
}

}  // namespace

void mix_in(std::uint8_t* pixel, const Rgb8& colour, double share) {
  for (int c = 0; c < 3; ++c) {
    pixel[c] = static_cast<std::uint8_t>(std::lround(pixel[c] + share * (colour[c] - pixel[c])));
  }
}

void draw_line(RgbImage& image, const Vector2d& from_px, const Vector2d& to_px, double width_px,
               const Rgb8& colour) {
  if (!from_px.allFinite() || !to_px.allFinite()) return;
  const Vector2d reach = Vector2d::Constant(0.5 * width_px + 1);
  const Vector2d size(image.width, image.height);
  const Vector2d low = (from_px.cwiseMin(to_px) - reach).cwiseMax(0.0).cwiseMin(size);
  const Vector2d high = (from_px.cwiseMax(to_px) + reach).cwiseMax(0.0).cwiseMin(size);
  for (int y = static_cast<int>(low.y()); y < static_cast<int>(high.y()); ++y) {
    for (int x = static_cast<int>(low.x()); x < static_cast<int>(high.x()); ++x) {
      const double away = distance_to_segment({x + 0.5, y + 0.5}, from_px, to_px);
      mix_in(image.at(x, y), colour, std::clamp(0.5 * width_px + 0.5 - away, 0.0, 1.0));
    }
  }
}

}  // namespace hydroprint::image
