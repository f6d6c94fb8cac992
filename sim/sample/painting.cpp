#include "sim/sample/painting.h"

#include <cmath>
#include <cstdint>

namespace hydroprint::sample {
namespace {

double lattice(std::int64_t x, std::int64_t y, std::int64_t z) {
  auto hash = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL ^
              static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL ^
              static_cast<std::uint64_t>(z) * 0x165667b19e3779f9ULL;
  hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9ULL;
  hash = (hash ^ hash >> 32) * 0x94d049bb133111ebULL;
  return static_cast<double>(hash >> 11) / static_cast<double>(1ULL << 52) - 1;
}

double value_noise(const Eigen::Vector3d& p) {
  const Eigen::Vector3d floor = p.array().floor();
  const Eigen::Vector3d t = p - floor;
  const Eigen::Vector3d s = t.array() * t.array() * (3 - 2 * t.array());
  const auto x = static_cast<std::int64_t>(floor.x());
  const auto y = static_cast<std::int64_t>(floor.y());
  const auto z = static_cast<std::int64_t>(floor.z());
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const int i = k & 1;
    const int j = k >> 1 & 1;
    const int l = k >> 2;
    sum += (i != 0 ? s.x() : 1 - s.x()) * (j != 0 ? s.y() : 1 - s.y()) *
           (l != 0 ? s.z() : 1 - s.z()) * lattice(x + i, y + j, z + l);
  }
  return sum;
}

}  // namespace

image::RgbImage draw(int width_px, int height_px, double units_per_px, int samples,
                     const std::function<Colour(double x, double y)>& colour_at) {
  image::RgbImage picture;
  picture.width = width_px;
  picture.height = height_px;
  picture.rgb.resize(3 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  for (int row = 0; row < height_px; ++row)
    for (int column = 0; column < width_px; ++column) {
      Colour sum = Colour::Zero();
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i)
          sum += colour_at((column + (i + 0.5) / samples) * units_per_px,
                           (height_px - row - (j + 0.5) / samples) * units_per_px);
      sum /= static_cast<float>(samples * samples);
      for (int c = 0; c < 3; ++c)
        picture.at(column, row)[c] =
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(sum[c], 0.0F, 1.0F)));
    }
  return picture;
}

double to_nearest_line(double x, double spacing) {
  return std::abs(x - spacing * std::round(x / spacing));
}

bool is_dark_square(double x, double y, double size) {
  const auto index = [&](double c) { return static_cast<std::int64_t>(std::floor(c / size)); };
  return ((index(x) + index(y)) & 1) != 0;
}

double noise(const Eigen::Vector3d& p, int octaves) {
  double sum = 0;
  double strength = 1;
  Eigen::Vector3d q = p;
  for (int i = 0; i < octaves; ++i) {
    sum += strength * value_noise(q);
    strength /= 2;
    q = 2 * q + Eigen::Vector3d(17.3, 5.7, 11.1);
  }
  return sum;
}

}  // namespace hydroprint::sample
