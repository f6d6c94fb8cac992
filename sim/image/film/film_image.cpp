#include "sim/image/film/film_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/base/check.h"
#include "sim/image/film/tile_bins.h"
#include "sim/image/io/colour.h"

namespace hydroprint::image {
namespace {

constexpr int kBlock_px = 64;
constexpr int kSamples = 4;
/// A rotated grid: no two samples are in one row or column, so edges near either axis are smooth.
const std::array<Eigen::Vector2d, kSamples> kOffsets = {
    Eigen::Vector2d(-0.125, -0.375), Eigen::Vector2d(0.375, -0.125), Eigen::Vector2d(0.125, 0.375),
    Eigen::Vector2d(-0.375, 0.125)};

/// A set of a pixel's samples: bit s for sample s.
using SampleSet = unsigned;
constexpr SampleSet kAllSamples = (1U << kSamples) - 1;

/// Mean position of the samples of each set, relative to the pixel's middle.
const std::array<Eigen::Vector2d, kAllSamples + 1>& mean_offsets() {
  static const auto offsets = [] {
    std::array<Eigen::Vector2d, kAllSamples + 1> out;
    for (SampleSet set = 0; set <= kAllSamples; ++set) {
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      for (int s = 0; s < kSamples; ++s) {
        if ((set >> s & 1) != 0) sum += kOffsets[s];
      }
      out[set] = sum / std::max(1, std::popcount(set));
    }
    return out;
  }();
  return offsets;
}

/// Distance beyond a tile's edge up to which its colours are used, relative to its size.
constexpr double kBeyondEdge = 0.5;

/// Returns the point at which a pixel's colour is looked up, once for all its samples. It is the
/// pixel's middle, so that tiles that share the pixel agree, unless the middle lies far outside a
/// tiny tile.
/// @param covered  the mean position of the samples that the tile covers
Eigen::Vector2d look_up_at(const BarycentricMap& map, const Eigen::Vector2d& middle,
                           const Eigen::Vector2d& covered) {
  return map.at(middle.x(), middle.y()).minCoeff() >= -kBeyondEdge ? middle : covered;
}

/// A block of the image while it is painted: colour and landing time of each sample.
class Block {
 public:
  explicit Block(const Window& window)
      : window_(window), pixels_(static_cast<std::size_t>(kBlock_px) * kBlock_px) {}

  /// @param at     the tile's corners on the pixel grid
  /// @param brush  at(x, y) returns the colour of a place on the pixel grid
  template <class TileBrush>
  void paint(const Corners& at, const std::array<float, 3>& time_s, const TileBrush& brush) {
    collect_spans(at);
    const BarycentricMap map(at);
    const TimePlane times(map, {time_s[0], time_s[1], time_s[2]});
    for (int y = first_row_; y <= last_row_; ++y) paint_row(y, map, times, brush);
  }

  /// Encodes the mean light of each pixel's samples.
  void resolve_light(RgbImage& image) const {
    const Srgb8Encoder encode;
    for (int y = window_.y0; y < window_.y1; ++y) {
      std::uint8_t* out = image.at(window_.x0, y);
      const Pixel* in = &pixels_[index(window_.x0, y)];
      for (int x = window_.x0; x < window_.x1; ++x, out += 3, ++in) {
        for (int c = 0; c < 3; ++c) {
          const auto& light = in->light[c];
          out[c] = encode((light[0] + light[1] + light[2] + light[3]) * (1.0F / kSamples));
        }
      }
    }
  }

  /// Stores the mean over those samples of each pixel where film lands, without encoding.
  void resolve_landed(RgbImage& image) const {
    for (int y = window_.y0; y < window_.y1; ++y) {
      std::uint8_t* out = image.at(window_.x0, y);
      const Pixel* in = &pixels_[index(window_.x0, y)];
      for (int x = window_.x0; x < window_.x1; ++x, out += 3, ++in) {
        for (int c = 0; c < 3; ++c) out[c] = mean_of_landed(in->light[c], in->landed_s);
      }
    }
  }

 private:
  using PerSample = std::array<float, kSamples>;

  /// The samples of a pixel; white film until something lands on them.
  struct Pixel {
    std::array<PerSample, 3> light = {
        PerSample{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}};  ///< linear
    PerSample landed_s = {HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF};
  };

  /// Contact time at the samples of a pixel, as a linear function of the pixel's position.
  struct TimePlane {
    TimePlane(const BarycentricMap& map, const Eigen::Vector3d& time_s)
        : per_x(map.per_x().dot(time_s)), per_y(map.per_y().dot(time_s)) {
      for (int s = 0; s < kSamples; ++s) {
        const Eigen::Vector2d place = Eigen::Vector2d(0.5, 0.5) + kOffsets[s];
        origin[s] = map.at(place.x(), place.y()).dot(time_s);
      }
    }
    Eigen::Array4d origin;
    double per_x, per_y;
  };

  struct Span {
    int begin = 0, end = 0;
  };
  using Spans = std::array<Span, kSamples>;

  static std::uint8_t mean_of_landed(const PerSample& values, const PerSample& landed_s) {
    float sum = 0;
    int landed = 0;
    for (int s = 0; s < kSamples; ++s) {
      if (landed_s[s] == HUGE_VALF) continue;
      sum += values[s];
      ++landed;
    }
    return landed == 0
               ? 0
               : static_cast<std::uint8_t>(std::lround(255 * sum / static_cast<float>(landed)));
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - window_.y0) * kBlock_px +
           static_cast<std::size_t>(x - window_.x0);
  }

  /// Rasterises the tile once per sample of a pixel.
  void collect_spans(const Corners& at) {
    first_row_ = window_.y1;
    last_row_ = window_.y0 - 1;
    for (int s = 0; s < kSamples; ++s) {
      const Corners shifted = {at[0] - kOffsets[s], at[1] - kOffsets[s], at[2] - kOffsets[s]};
      for_each_span(shifted, window_, [&](int y, int begin, int end) {
        if (y < first_row_ || y > last_row_) clear_rows(y);
        rows_[y - window_.y0][s] = {begin, end};
      });
    }
  }

  void clear_rows(int y) {
    const int begin = first_row_ > last_row_ ? y : std::min(y, last_row_ + 1);
    const int end = first_row_ > last_row_ ? y : std::max(y, first_row_ - 1);
    for (int row = begin; row <= end; ++row) rows_[row - window_.y0] = {};
    first_row_ = std::min(first_row_, y);
    last_row_ = std::max(last_row_, y);
  }

  template <class TileBrush>
  void paint_row(int y, const BarycentricMap& map, const TimePlane& times, const TileBrush& brush) {
    const Spans& spans = rows_[y - window_.y0];
    // Ranges of the pixels with at least one covered sample, and with all samples covered.
    Span some{window_.x1, window_.x0}, all{window_.x0, window_.x1};
    for (const Span& span : spans) {
      all = {std::max(all.begin, span.begin), std::min(all.end, span.end)};
      if (span.begin >= span.end) continue;
      some = {std::min(some.begin, span.begin), std::max(some.end, span.end)};
    }
    const Eigen::Array4d row_times = times.origin + times.per_y * y;
    for (int x = some.begin; x < some.end; ++x) {
      Pixel& pixel = pixels_[index(x, y)];
      const Eigen::Array4f time_s = (row_times + times.per_x * x).cast<float>();
      const SampleSet covered = x >= all.begin && x < all.end ? kAllSamples : samples_at(x, spans);
      const SampleSet mine = covered & earlier(time_s, pixel);
      if (mine == 0) continue;
      const Eigen::Vector2d middle(x + 0.5, y + 0.5);
      const Eigen::Vector2d place =
          mine == kAllSamples ? middle : look_up_at(map, middle, middle + mean_offsets()[mine]);
      put(pixel, mine, brush.at(place.x(), place.y()), time_s);
    }
  }

  static SampleSet samples_at(int x, const Spans& spans) {
    SampleSet set = 0;
    for (int s = 0; s < kSamples; ++s) {
      if (x >= spans[s].begin && x < spans[s].end) set |= 1U << s;
    }
    return set;
  }

  static SampleSet earlier(const Eigen::Array4f& time_s, const Pixel& pixel) {
    SampleSet set = 0;
    for (int s = 0; s < kSamples; ++s) {
      set |= static_cast<SampleSet>(time_s[s] < pixel.landed_s[s]) << s;
    }
    return set;
  }

  static void put(Pixel& pixel, SampleSet set, const Eigen::Vector3f& light,
                  const Eigen::Array4f& time_s) {
    for (int s = 0; s < kSamples; ++s) {
      if ((set >> s & 1) == 0) continue;
      for (int c = 0; c < 3; ++c) pixel.light[c][s] = light[c];
      pixel.landed_s[s] = time_s[s];
    }
  }

  Window window_;
  std::vector<Pixel> pixels_;
  std::array<Spans, kBlock_px> rows_;
  int first_row_ = 0, last_row_ = -1;
};

/// The weight of a tile's points, as a brush.
class WeightBrush {
 public:
  WeightBrush(const Weight& weight, const flow::MappedTriangle& tile, const Corners& at)
      : weight_(weight), tile_(tile), map_(at) {}

  [[nodiscard]] Eigen::Vector3f at(double x, double y) const {
    // A pixel's middle may lie beyond the edge of a tile that covers one of its samples.
    const Eigen::Vector3d in_tile = map_.at(x, y).cwiseMax(0.0);
    Eigen::Vector3d in_triangle = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) in_triangle += in_tile[i] * tile_.barycentric[i].cast<double>();
    return Eigen::Vector3f::Constant(weight_(tile_.triangle, in_triangle / in_triangle.sum()));
  }

 private:
  const Weight& weight_;
  const flow::MappedTriangle& tile_;
  BarycentricMap map_;
};

/// Paints the tiles on the blocks of an image.
/// @param brush_of  returns the brush of a tile with its corners on the pixel grid
/// @param resolve   copies a painted block to the image
template <class BrushOf, class Resolve>
Status paint_tiles(const std::vector<flow::MappedTriangle>& tiles, const FilmGrid& grid,
                   const Context& context, const BrushOf& brush_of, const Resolve& resolve) {
  const TileBins bins(tiles, grid, kBlock_px);
  return parallel_for(context, "film image", bins.count(), [&](std::size_t b) {
    const auto in_block = bins.tiles(b);
    if (in_block.empty()) return Status{};
    Block block(bins.window(b));
    for (const int t : in_block) {
      const flow::MappedTriangle& tile = tiles[t];
      const Corners at = {grid.cell(tile.film_mm[0]), grid.cell(tile.film_mm[1]),
                          grid.cell(tile.film_mm[2])};
      block.paint(at, tile.contact_time_s, brush_of(tile, at));
    }
    resolve(block);
    return Status{};
  });
}

/// Returns an image of the film in one colour.
RgbImage blank_image(const FilmGrid& grid, std::uint8_t channel) {
  RgbImage image{grid.columns, grid.rows, {}};
  image.rgb.assign(3 * static_cast<std::size_t>(grid.columns) * grid.rows, channel);
  return image;
}

Status check_size(const film::Outline& outline, double dpi) {
  if (!(dpi >= kMinDpi && dpi <= kMaxDpi)) {
    return fail(Code::kOutOfRange, fmt::format("{} dpi is out of range ({} to {}). Give the "
                                               "resolution of the printer, such as 300 or 600",
                                               dpi, kMinDpi, kMaxDpi));
  }
  const Eigen::Vector2d size_px = outline.size_mm() * dpi / 25.4;
  if (!(size_px.x() * size_px.y() <= kMaxFilmImage_px)) {
    return fail(
        Code::kOutOfRange,
        fmt::format(
            "dpi {} on film {}: the image would have more than 400 million pixels. Lower the dpi",
            dpi, outline.name));
  }
  return {};
}

}  // namespace

FilmGrid film_grid(const film::Outline& outline, double pitch_mm) {
  const Eigen::Vector2d cells = outline.size_mm() / pitch_mm;
  const Eigen::Vector2d centre = 0.5 * (outline.min_mm + outline.max_mm);
  FilmGrid grid;
  grid.columns = std::max(1, static_cast<int>(std::lround(cells.x())));
  grid.rows = std::max(1, static_cast<int>(std::lround(cells.y())));
  grid.pitch_mm = pitch_mm;
  grid.left_mm = centre.x() - 0.5 * grid.columns * pitch_mm;
  grid.top_mm = centre.y() + 0.5 * grid.rows * pitch_mm;
  return grid;
}

Result<RgbImage> film_image(const mesh::Surface& surface,
                            const std::vector<flow::MappedTriangle>& tiles,
                            const SurfacePaint& paint, const film::Outline& outline, double dpi,
                            const Context& context) {
  HP_CHECK(surface.source_triangle.size() == surface.triangles.size());
  HP_RETURN_IF_ERROR(check_size(outline, dpi));
  const FilmGrid grid = film_grid(outline, 25.4 / dpi);
  RgbImage image = blank_image(grid, 255);
  if (!paint.has_colour()) return image;
  const auto brush_of = [&](const flow::MappedTriangle& tile, const Corners& at) {
    return paint.brush(surface, tile, at);
  };
  HP_RETURN_IF_ERROR(paint_tiles(tiles, grid, context, brush_of,
                                 [&image](const Block& block) { block.resolve_light(image); }));
  return image;
}

Result<RgbImage> film_mask(const std::vector<flow::MappedTriangle>& tiles, const Weight& weight,
                           const film::Outline& outline, double dpi, const Context& context) {
  HP_RETURN_IF_ERROR(check_size(outline, dpi));
  const FilmGrid grid = film_grid(outline, 25.4 / dpi);
  RgbImage mask = blank_image(grid, 0);
  const auto brush_of = [&](const flow::MappedTriangle& tile, const Corners& at) {
    return WeightBrush(weight, tile, at);
  };
  HP_RETURN_IF_ERROR(paint_tiles(tiles, grid, context, brush_of,
                                 [&mask](const Block& block) { block.resolve_landed(mask); }));
  return mask;
}

RgbImage seen_through(const RgbImage& mask, const RgbImage& image) {
  HP_CHECK(mask.rgb.size() == image.rgb.size());
  RgbImage out = image;
  for (std::size_t i = 0; i < out.rgb.size(); ++i) {
    const int ink = 255 - image.rgb[i];
    out.rgb[i] = static_cast<std::uint8_t>(255 - (ink * mask.rgb[i] + 127) / 255);
  }
  return out;
}

}  // namespace hydroprint::image
