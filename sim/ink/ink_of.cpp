#include "sim/ink/ink_of.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "sim/base/check.h"
#include "sim/image/film/film_texture.h"
#include "sim/image/io/image_file.h"
#include "sim/image/io/printer_image.h"
#include "sim/ink/separation.h"

namespace hydroprint::ink {
namespace {

/// Access to an image by rows (8-bit sRGB, row 0 at the top); `row` returns row y, which it may
/// store in `buffer`.
struct Rows {
  int width, height;
  std::function<const std::uint8_t*(int y, std::vector<std::uint8_t>& buffer)> row;
};

/// The range of pixels that a cell covers along one axis, in pixels from the outer edge of the
/// first pixel.
struct Span {
  double from, to;

  [[nodiscard]] int begin() const { return static_cast<int>(from); }
  [[nodiscard]] int end() const { return static_cast<int>(std::ceil(to)); }
  [[nodiscard]] double share(int pixel) const {
    return std::min<double>(to, pixel + 1) - std::max<double>(from, pixel);
  }
};

/// @param first_px, cell_px  start of cell 0 and size of the cells, in pixels
std::vector<Span> spans(int cells, double first_px, double cell_px, int pixels) {
  HP_CHECK(cells > 0);
  HP_CHECK(cell_px > 0);
  HP_CHECK(pixels > 0);
  const auto edge = [&](int cell) {
    return std::clamp(first_px + cell * cell_px, 0.0, static_cast<double>(pixels));
  };
  std::vector<Span> out;
  out.reserve(static_cast<std::size_t>(cells));
  for (int cell = 0; cell < cells; ++cell) out.push_back({edge(cell), edge(cell + 1)});
  return out;
}

double covered(const std::vector<double>& t, const Span& span) {
  const int begin = span.begin(), end = span.end();
  double sum = 0;
  if (begin < end) sum += span.share(begin) * t[begin];
  for (int x = begin + 1; x < end - 1; ++x) sum += t[x];
  if (begin + 1 < end) sum += span.share(end - 1) * t[end - 1];
  return sum;
}

Result<InkField> average(const Rows& image, const film::Outline& outline, const InkOptions& options,
                         const Context& context) {
  HP_ASSIGN_OR_RETURN(const Separation separation, make_separation(options.icc_profile));
  const InkGrid grid = ink_grid(outline, options.cell_mm);
  const auto extent = image::image_extent(image.width, image.height, outline);
  const Eigen::Vector2d px_mm =
      extent.size_mm.cwiseQuotient(Eigen::Vector2d(image.width, image.height));
  const Eigen::Vector2d cell_px = grid.cell_mm.cwiseQuotient(px_mm);
  // Start of the first cell; y is counted from the top, like the image's rows.
  const Eigen::Vector2d first_px =
      Eigen::Vector2d(outline.min_mm.x() - extent.low_mm.x(),
                      extent.low_mm.y() + extent.size_mm.y() - outline.max_mm.y())
          .cwiseQuotient(px_mm);
  const auto across = spans(grid.columns, first_px.x(), cell_px.x(), image.width);
  const auto down = spans(grid.rows, first_px.y(), cell_px.y(), image.height);

  std::vector<double> means(grid.count());
  HP_RETURN_IF_ERROR(parallel_for(context, "ink", down.size(), [&](std::size_t j) {
    double* cells = &means[(down.size() - 1 - j) * across.size()];
    std::vector<double> t(static_cast<std::size_t>(image.width));
    std::vector<std::uint8_t> buffer;
    for (int y = down[j].begin(); y < down[j].end(); ++y) {
      separation(image.row(y, buffer), t.size(), t.data());
      for (std::size_t i = 0; i < across.size(); ++i) {
        cells[i] += down[j].share(y) * covered(t, across[i]);
      }
    }
    for (std::size_t i = 0; i < across.size(); ++i) {
      cells[i] = std::min(cells[i] / cell_px.prod(), kMostInk);  // removes rounding errors
    }
    return Status{};
  }));
  return InkField::from_means(grid, means);
}

}  // namespace

Result<InkField> ink_of(const image::RgbImage& film_image, const film::Outline& outline,
                        const InkOptions& options, const Context& context) {
  return average({film_image.width, film_image.height,
                  [&](int y, std::vector<std::uint8_t>&) { return film_image.at(0, y); }},
                 outline, options, context);
}

Result<InkField> read_ink_image(const std::filesystem::path& path, const film::Outline& outline,
                                const InkOptions& options, const Context& context) {
  HP_ASSIGN_OR_RETURN(const image::ReadImage read, image::read_image(path, context));
  const image::Texels& image = read.image;
  const auto row = [&](int y, std::vector<std::uint8_t>& buffer) {
    buffer.resize(3 * static_cast<std::size_t>(image.width));
    image::srgb8_row(image, y, buffer.data());
    return buffer.data();
  };
  return average({image.width, image.height, row}, outline, options, context);
}

}  // namespace hydroprint::ink
