#include "sim/image/texture/texture.h"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>

namespace hydroprint::image {
namespace {

constexpr int kMaxProbes = 16;
constexpr int kRowsAtOnce = 32;

/// Returns the mean of up to four texels, using only those of their most frequent chart. Uses all
/// of them if none has a chart.
Texel mean(const std::array<const Texel*, 4>& children, int count) {
  std::uint16_t chart = 0;
  int most = 0;
  for (int i = 0; i < count; ++i) {
    int votes = 0;
    for (int k = 0; k < count; ++k) votes += children[k]->chart == children[i]->chart ? 1 : 0;
    if (children[i]->chart != 0 && votes > most) {
      most = votes;
      chart = children[i]->chart;
    }
  }
  std::uint32_t r = 0, g = 0, b = 0, n = 0;
  for (int i = 0; i < count; ++i) {
    if (children[i]->chart != chart) continue;
    r += children[i]->r;
    g += children[i]->g;
    b += children[i]->b;
    ++n;
  }
  const auto share = [n](std::uint32_t sum) {
    return static_cast<std::uint16_t>((sum + n / 2) / n);
  };
  return {share(r), share(g), share(b), chart};
}

void halve_row(const Texels& from, int y, Texels& to) {
  for (int x = 0; x < to.width; ++x) {
    std::array<const Texel*, 4> children{};
    int count = 0;
    for (int fy = 2 * y; fy < std::min(2 * y + 2, from.height); ++fy) {
      for (int fx = 2 * x; fx < std::min(2 * x + 2, from.width); ++fx) {
        children[count++] = &from.texels[static_cast<std::size_t>(fy) * from.width + fx];
      }
    }
    to.texels[static_cast<std::size_t>(y) * to.width + x] = mean(children, count);
  }
}

Status halve(const Texels& from, Texels& to, const Context& context) {
  to.width = (from.width + 1) / 2;
  to.height = (from.height + 1) / 2;
  to.texels.resize(static_cast<std::size_t>(to.width) * to.height);
  const auto chunks = static_cast<std::size_t>((to.height + kRowsAtOnce - 1) / kRowsAtOnce);
  return parallel_for(context, {}, chunks, [&](std::size_t chunk) -> Status {
    const int begin = static_cast<int>(chunk) * kRowsAtOnce;
    const int end = std::min(begin + kRowsAtOnce, to.height);
    for (int y = begin; y < end; ++y) halve_row(from, y, to);
    return {};
  });
}

/// std::floor is a library call on plain x86-64; this function is inlined. Exact up to 2^62,
/// otherwise 0.
inline double fast_floor(double t) {
  if (!(std::abs(t) < 4e18)) return 0;
  const auto whole = static_cast<double>(static_cast<std::int64_t>(t));
  return whole > t ? whole - 1 : whole;
}

inline double clamp01(double t) { return t > 0 ? std::min(t, 1.0) : 0; }  // NaN becomes 0

double fold_axis(double t, mesh::Wrap wrap, bool in_one_tile, double tile) {
  if (in_one_tile && wrap != mesh::Wrap::kClamp) {
    const double inside = clamp01(t - tile);
    const bool flipped = wrap == mesh::Wrap::kMirror && std::fmod(std::abs(tile), 2) == 1;
    return flipped ? 1 - inside : inside;
  }
  switch (wrap) {
    case mesh::Wrap::kRepeat:
      return clamp01(t - fast_floor(t));
    case mesh::Wrap::kMirror: {
      const double twice = t - 2 * fast_floor(t / 2);
      return clamp01(twice > 1 ? 2 - twice : twice);
    }
    case mesh::Wrap::kClamp:
      break;
  }
  return clamp01(t);
}

/// Two neighbouring texels along one axis, and the weight of the second.
struct Taps {
  int first = 0, second = 0;
  float blend = 0;
};

inline Taps taps_at(double position, int size, bool wraps) {
  const double floor = fast_floor(position);
  Taps taps;
  taps.first = static_cast<int>(floor);
  taps.second = taps.first + 1;
  taps.blend = static_cast<float>(position - floor);
  if (taps.first < 0) taps.first = wraps ? size - 1 : 0;
  if (taps.second >= size) taps.second = wraps ? 0 : size - 1;
  taps.first = std::min(taps.first, size - 1);
  return taps;
}

using Shorts = std::uint16_t __attribute__((vector_size(8)));
using Floats = float __attribute__((vector_size(16)));

/// Converts r, g, b and an unused value simultaneously.
inline Floats floats(const Texel& texel) {
  return __builtin_convertvector(std::bit_cast<Shorts>(texel), Floats);
}

inline Floats lerp(const Floats& a, const Floats& b, float blend) { return a + blend * (b - a); }

/// Bilinear interpolation between four texels.
inline Eigen::Vector3f mix(const std::array<const Texel*, 4>& texel, float right, float down) {
  const Floats above = lerp(floats(*texel[0]), floats(*texel[1]), right);
  const Floats below = lerp(floats(*texel[2]), floats(*texel[3]), right);
  const Floats mean = lerp(above, below, down);
  return {mean[0], mean[1], mean[2]};
}

inline bool are_of_chart(const std::array<const Texel*, 4>& texel, std::uint16_t id) {
  return id == 0 || ((texel[0]->chart == id) & (texel[1]->chart == id) & (texel[2]->chart == id) &
                     (texel[3]->chart == id));
}

}  // namespace

Result<Texture> Texture::build(Texels texels, mesh::Wrap wrap_u, mesh::Wrap wrap_v,
                               const Context& context) {
  Texture texture;
  texture.wrap_ = {wrap_u, wrap_v};
  texture.levels_.push_back(std::move(texels));
  while (texture.levels_.back().texels.size() > 1) {
    Texels next;
    HP_RETURN_IF_ERROR(halve(texture.levels_.back(), next, context));
    texture.levels_.push_back(std::move(next));
  }
  return texture;
}

Texture::Footprint Texture::footprint(const Eigen::Matrix2d& uv_per_sample) const {
  Footprint footprint;
  const Eigen::Matrix2d texels = Eigen::Vector2d(width(), height()).asDiagonal() * uv_per_sample;
  if (!texels.allFinite()) {
    footprint.level = static_cast<int>(levels_.size()) - 1;
    return footprint;
  }
  // The longer axis of the footprint's ellipse: leading right singular vector.
  const Eigen::Matrix2d gram = texels.transpose() * texels;
  const double angle = 0.5 * std::atan2(2 * gram(0, 1), gram(0, 0) - gram(1, 1));
  const Eigen::Vector2d axis(std::cos(angle), std::sin(angle));
  const double longer = (texels * axis).norm();
  const double shorter = longer > 0 ? std::abs(texels.determinant()) / longer : 0;
  const double width_texels = std::max({shorter, longer / kMaxProbes, 1.0});
  footprint.probes =
      std::clamp(static_cast<int>(std::ceil(longer / width_texels - 0.01)), 1, kMaxProbes);
  footprint.step_uv = uv_per_sample * axis / footprint.probes;
  const double level = std::min(std::log2(width_texels), static_cast<double>(levels_.size()) - 1);
  footprint.level = static_cast<int>(level);
  footprint.blend = static_cast<float>(level - footprint.level);
  return footprint;
}

Eigen::Vector2d Texture::fold(const Eigen::Vector2d& uv, const Chart& chart) const {
  return {fold_axis(uv.x(), wrap_[0], chart.in_one_tile[0], chart.tile[0]),
          fold_axis(uv.y(), wrap_[1], chart.in_one_tile[1], chart.tile[1])};
}

Texture::Shortcut Texture::shortcut(const Eigen::Vector2d& uv, const Eigen::Matrix2d& uv_per_sample,
                                    const Footprint& footprint, const Chart& chart) const {
  Shortcut out;
  if (footprint.probes > 1 || footprint.level > 0 || footprint.blend > 0) return out;
  Eigen::Vector2d tile = Eigen::Vector2d::Zero();
  for (int i = 0; i < 2; ++i) {
    if (wrap_[i] == mesh::Wrap::kMirror) return out;
    if (wrap_[i] == mesh::Wrap::kRepeat) {
      tile[i] = chart.in_one_tile[i] ? chart.tile[i] : fast_floor(uv[i]);
    }
  }
  const Eigen::Vector2d in_tile = uv - tile;
  out.origin_ = {in_tile.x() * width() - 0.5, (1 - in_tile.y()) * height() - 0.5};
  out.per_sample_ = Eigen::Vector2d(width(), -height()).asDiagonal() * uv_per_sample;
  out.chart_ = chart.id;
  out.image_ = &levels_[0];
  return out;
}

bool Texture::Shortcut::sample(const Eigen::Vector2d& offset, Eigen::Vector3f& colour) const {
  if (image_ == nullptr) return false;
  const Eigen::Vector2d at = origin_ + per_sample_ * offset;
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() < image_->width - 1 && at.y() < image_->height - 1)) {
    return false;
  }
  const int x = static_cast<int>(at.x()), y = static_cast<int>(at.y());
  const Texel* upper = &image_->texels[static_cast<std::size_t>(y) * image_->width + x];
  const Texel* lower = upper + image_->width;
  const std::array<const Texel*, 4> texels = {upper, upper + 1, lower, lower + 1};
  if (!are_of_chart(texels, chart_)) return false;
  const auto right = static_cast<float>(at.x() - x), down = static_cast<float>(at.y() - y);
  colour = mix(texels, right, down) / 65535.0F;
  return true;
}

Texture::Sum Texture::bilinear(const Eigen::Vector2d& folded, int level, const Chart& chart) const {
  const Texels& image = levels_[level];
  const double scale = 1.0 / static_cast<double>(1 << level);
  const bool wraps_u = wrap_[0] == mesh::Wrap::kRepeat && !chart.in_one_tile[0];
  const bool wraps_v = wrap_[1] == mesh::Wrap::kRepeat && !chart.in_one_tile[1];
  const Taps x = taps_at(folded.x() * width() * scale - 0.5, image.width, wraps_u);
  const Taps y = taps_at((1 - folded.y()) * height() * scale - 0.5, image.height, wraps_v);
  const Texel* upper = &image.texels[static_cast<std::size_t>(y.first) * image.width];
  const Texel* lower = &image.texels[static_cast<std::size_t>(y.second) * image.width];
  const std::array<const Texel*, 4> texels = {upper + x.first, upper + x.second, lower + x.first,
                                              lower + x.second};
  if (are_of_chart(texels, chart.id)) return {mix(texels, x.blend, y.blend), 1};
  Sum sum;
  const auto add = [&](int column, const Texel* row, float weight) {
    const Texel& texel = row[column];
    if (texel.chart != chart.id) return;
    sum.colour += weight * Eigen::Vector3f(texel.r, texel.g, texel.b);
    sum.weight += weight;
  };
  add(x.first, upper, (1 - x.blend) * (1 - y.blend));
  add(x.second, upper, x.blend * (1 - y.blend));
  add(x.first, lower, (1 - x.blend) * y.blend);
  add(x.second, lower, x.blend * y.blend);
  return sum;
}

Texture::Sum Texture::trilinear(const Eigen::Vector2d& folded, const Footprint& footprint,
                                const Chart& chart) const {
  Sum sum = bilinear(folded, footprint.level, chart);
  if (footprint.blend <= 0) return sum;
  const Sum coarse = bilinear(folded, footprint.level + 1, chart);
  // The weight of a level does not depend on how many of its texels belong to the chart.
  if (coarse.weight <= 0) return sum;
  if (sum.weight <= 0) return coarse;
  sum.colour = sum.colour / sum.weight * (1 - footprint.blend) +
               coarse.colour / coarse.weight * footprint.blend;
  sum.weight = 1;
  return sum;
}

Eigen::Vector3f Texture::nearest(const Eigen::Vector2d& folded) const {
  const Texels& image = levels_[0];
  const int x = std::min(static_cast<int>(folded.x() * image.width), image.width - 1);
  const int y = std::min(static_cast<int>((1 - folded.y()) * image.height), image.height - 1);
  const Texel& texel = image.texels[static_cast<std::size_t>(y) * image.width + x];
  return Eigen::Vector3f(texel.r, texel.g, texel.b) / 65535.0F;
}

Eigen::Vector3f Texture::sample(const Eigen::Vector2d& uv, const Footprint& footprint,
                                const Chart& chart) const {
  if (footprint.probes == 1) {
    const Sum sum = trilinear(fold(uv, chart), footprint, chart);
    if (sum.weight > 0) return sum.colour / (sum.weight * 65535.0F);
    return finer(uv, footprint, chart);
  }
  Sum total;
  for (int probe = 0; probe < footprint.probes; ++probe) {
    const double along = probe + 0.5 * (1 - footprint.probes);
    const Sum sum = trilinear(fold(uv + along * footprint.step_uv, chart), footprint, chart);
    if (sum.weight <= 0) continue;
    total.colour += sum.colour / sum.weight;
    total.weight += 1;
  }
  if (total.weight > 0) return total.colour / (total.weight * 65535.0F);
  return finer(uv, footprint, chart);
}

Eigen::Vector3f Texture::finer(const Eigen::Vector2d& uv, const Footprint& footprint,
                               const Chart& chart) const {
  // All coarse texels around a narrow chart may belong to its neighbours. Finer levels can still
  // have texels of the chart.
  const Eigen::Vector2d folded = fold(uv, chart);
  for (int level = footprint.level - 1; level >= 0; --level) {
    const Sum sum = bilinear(folded, level, chart);
    if (sum.weight > 0) return sum.colour / (sum.weight * 65535.0F);
  }
  return nearest(folded);
}

}  // namespace hydroprint::image
