#include "sim/print/print_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sim/base/number_text.h"
#include "sim/image/film/film_image.h"
#include "sim/image/io/image_file.h"
#include "sim/image/io/printer_image.h"

namespace hydroprint::print {
namespace {

constexpr double kMmPerInch = 25.4;

/// Returns "2480 x 3508".
std::string size_text(int width, int height) { return fmt::format("{} x {}", width, height); }

/// Returns the resolution at which a film image of this film has the size of `image`: `given`, or a
/// whole number of dots per inch.
Result<double> dpi_of(const image::RgbImage& image, const std::string& name,
                      const film::Outline& outline, std::optional<double> given) {
  const double guess = std::max(1.0, std::round(image.width * kMmPerInch / outline.size_mm().x()));
  const double dpi = given.value_or(guess);
  if (!(dpi >= image::kMinDpi && dpi <= image::kMaxDpi)) {
    return fail(Code::kOutOfRange,
                fmt::format("{}: {} dpi is out of range. Use an image of {} to {} dpi", name, dpi,
                            image::kMinDpi, image::kMaxDpi));
  }
  const image::FilmGrid grid = image::film_grid(outline, kMmPerInch / dpi);
  if (grid.columns == image.width && grid.rows == image.height) return dpi;
  return fail(
      Code::kInvalidArgument,
      fmt::format("{}: has {} pixels, but a film image of {} at {} dpi has {}. Give the film "
                  "and the resolution of the image",
                  name, size_text(image.width, image.height), outline.name, dpi,
                  size_text(grid.columns, grid.rows)));
}

void mirror(image::PrinterImage& image) {
  for (int y = 0; y < image.height; ++y) {
    for (int left = 0, right = image.width - 1; left < right; ++left, --right) {
      std::swap_ranges(image.at(left, y), image.at(left, y) + image.channels, image.at(right, y));
    }
  }
}

bool has_colour(const std::uint8_t* pixel, int channels) {
  const std::uint8_t nothing = channels == 4 ? 0 : 255;
  return std::any_of(pixel, pixel + channels, [nothing](std::uint8_t c) { return c != nothing; });
}

/// A sheet's part of an image, and the number of its coloured pixels that cannot be printed.
/// `at_edge` names the affected edges of the paper: left, right, top, bottom.
struct Part {
  image::PrinterImage image;
  std::size_t lost = 0;
  std::array<bool, 4> at_edge{};
};

void clear_pixel(Part& part, std::uint8_t* pixel) {
  if (!has_colour(pixel, part.image.channels)) return;
  ++part.lost;
  std::fill(pixel, pixel + part.image.channels,
            static_cast<std::uint8_t>(part.image.channels == 4 ? 0 : 255));
}

Part part_of(const image::PrinterImage& image, const Sheet& sheet) {
  const Pixels& window = sheet.window;
  const Pixels& kept = sheet.printable;
  Part out;
  out.image = {window.width(), window.height(), image.channels, {}};
  out.image.samples.reserve(out.image.row_bytes() * static_cast<std::size_t>(out.image.height));
  for (int y = window.y0; y < window.y1; ++y) {
    const std::uint8_t* row = image.at(window.x0, y);
    out.image.samples.insert(out.image.samples.end(), row, row + out.image.row_bytes());
  }
  for (int y = window.y0; y < window.y1; ++y) {
    const bool in_rows = y >= kept.y0 && y < kept.y1;
    for (int x = window.x0; x < window.x1; ++x) {
      if (in_rows && x == kept.x0 && kept.x1 > kept.x0) x = kept.x1;
      if (x >= window.x1) break;
      const std::size_t before = out.lost;
      clear_pixel(out, out.image.at(x - window.x0, y - window.y0));
      if (out.lost == before) continue;
      const std::array<bool, 4> edges = {x < kept.x0, x >= kept.x1, y < kept.y0, y >= kept.y1};
      for (std::size_t i = 0; i < edges.size(); ++i) out.at_edge[i] = out.at_edge[i] || edges[i];
    }
  }
  return out;
}

Warning margin_warning(const Part& part, std::size_t number_of_sheet, double margin_mm,
                       double lost_mm2) {
  constexpr std::array<const char*, 4> kEdges = {"left", "right", "top", "bottom"};
  std::string edges;
  for (std::size_t i = 0; i < kEdges.size(); ++i) {
    if (part.at_edge[i]) edges += (edges.empty() ? "" : ", ") + std::string(kEdges[i]);
  }
  return {WarningCode::IMAGE_IN_PRINTER_MARGIN,
          fmt::format(
              "{} mm2 of the image lie within {} mm of the paper's edge ({}), which the printer "
              "cannot print, and stay white; place the object nearer the film's middle, or "
              "print without margin",
              three_digits(lost_mm2), margin_mm, edges),
          {OnSheet{static_cast<int>(number_of_sheet)}}};
}

void add_pages(const image::PrinterImage& image, const PrintSettings& settings, Print& print) {
  const double pixel_mm2 = print.layout.pitch_mm * print.layout.pitch_mm;
  for (const Sheet& sheet : print.layout.sheets) {
    Part part = part_of(image, sheet);
    const double lost_mm2 = static_cast<double>(part.lost) * pixel_mm2;
    print.cut_off_mm2 += lost_mm2;
    if (part.lost > 0) {
      print.warnings.push_back(margin_warning(part, print.document.pages.size() + 1,
                                              settings.page.printer_margin_mm, lost_mm2));
    }
    Page page;
    page.size_mm = sheet.size_mm;
    page.images.push_back({std::move(part.image), print.layout.pitch_mm, sheet.low_mm});
    page.strokes = sheet.marks;
    page.texts = sheet.texts;
    print.document.pages.push_back(std::move(page));
  }
}

}  // namespace

Result<image::RgbImage> read_film_image(const std::filesystem::path& path, const Context& context) {
  HP_ASSIGN_OR_RETURN(const image::ReadImage read, image::read_image(path, context));
  image::RgbImage out{read.image.width, read.image.height, {}};
  out.rgb.resize(3 * read.image.texels.size());
  for (int y = 0; y < out.height; ++y) image::srgb8_row(read.image, y, out.at(0, y));
  return out;
}

Result<Print> print_image(const image::RgbImage& film_image, const std::string& name,
                          const film::Outline& outline, const PrintSettings& settings,
                          const Context& context) {
  Print out;
  HP_ASSIGN_OR_RETURN(out.dpi, dpi_of(film_image, name, outline, settings.dpi));
  const image::FilmGrid grid = image::film_grid(outline, kMmPerInch / out.dpi);
  HP_ASSIGN_OR_RETURN(out.layout, lay_out(grid, outline, settings.page));
  out.warnings = out.layout.warnings;

  HP_ASSIGN_OR_RETURN(PrinterColoured coloured,
                      printer_coloured(film_image, settings.colours, context));
  out.most_ink = coloured.most_ink;
  out.limited_share = coloured.limited_share;
  if (settings.page.mirror) mirror(coloured.image);
  out.document.title = settings.page.job_name;
  out.document.cmyk = coloured.image.channels == 4;
  out.document.icc_profile = std::move(coloured.icc_profile);
  add_pages(coloured.image, settings, out);
  return out;
}

}  // namespace hydroprint::print
