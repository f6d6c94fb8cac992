#include "sim/sample/chart.h"

#include <cmath>

namespace hydroprint::sample {

image::RgbImage Sheet::draw() const {
  const auto colour = [this](double x, double y) -> Colour {
    for (const auto& chart : charts) {
      const Eigen::Vector2d place = Eigen::Vector2d(x, y) - chart.origin_mm;
      if ((place.array() >= -kGutterMm).all() &&
          (place.array() <= chart.size_mm.array() + kGutterMm).all())
        return chart.colour_at(place.x(), place.y());
    }
    return {1, 1, 1};
  };
  return sample::draw(static_cast<int>(std::lround(size_mm.x() * px_per_mm)),
                      static_cast<int>(std::lround(size_mm.y() * px_per_mm)), 1 / px_per_mm, 2,
                      colour);
}

}  // namespace hydroprint::sample
