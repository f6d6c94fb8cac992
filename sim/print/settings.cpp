#include "sim/print/settings.h"

#include <fmt/format.h>

#include <utility>

#include "sim/film/outline.h"

namespace hydroprint::print {
namespace {

constexpr double kLeastPrintable_mm = 20;
constexpr double kMostOverlap_mm = 100;
constexpr double kMostBar_mm = 2000;

tl::unexpected<Error> out_of_range(const std::string& what, double value, double most) {
  return fail(Code::kOutOfRange,
              fmt::format("{}: {} mm is out of range. Use 0 to {} mm", what, value, most));
}

}  // namespace

Result<Eigen::Vector2d> parse_paper(const std::string& text) {
  const std::string about = "paper '" + text + "': ";
  // A film may have shapes that paper does not have.
  const bool is_shape = text.find(':') != std::string::npos;
  const auto outline = film::parse_outline(is_shape ? "" : text);
  if (outline) return outline->size_mm();
  if (outline.error().code == Code::kOutOfRange) {
    return fail(Code::kOutOfRange, about + "out of range. Use sides from 10 to 2000 mm");
  }
  return fail(Code::kInvalidArgument,
              about + "unknown size. Use A4, A3, letter or WIDTHxHEIGHT (mm)");
}

Status check(const PageSettings& settings) {
  const double most_margin_mm = (settings.paper_mm.minCoeff() - kLeastPrintable_mm) / 2;
  if (most_margin_mm < 0) {
    return fail(Code::kOutOfRange, "paper: too small to print on. Use sides of 20 mm or more");
  }
  if (!(settings.printer_margin_mm >= 0 && settings.printer_margin_mm <= most_margin_mm)) {
    return out_of_range("printer margin", settings.printer_margin_mm, most_margin_mm);
  }
  if (!(settings.overlap_mm >= 0 && settings.overlap_mm <= kMostOverlap_mm)) {
    return out_of_range("overlap", settings.overlap_mm, kMostOverlap_mm);
  }
  if (!(settings.bar_mm >= 0 && settings.bar_mm <= kMostBar_mm)) {
    return out_of_range("sliding bar", settings.bar_mm, kMostBar_mm);
  }
  return {};
}

}  // namespace hydroprint::print
