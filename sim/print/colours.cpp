#include "sim/print/colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "sim/base/check.h"
#include "sim/ink/ink_field.h"
#include "sim/ink/printer_colours.h"

namespace hydroprint::print {
namespace {

constexpr double kFull = 255;

/// Converts `count` pixels R G B to the printer's channels.
using Convert = std::function<void(const std::uint8_t* rgb, std::size_t count, std::uint8_t* out)>;

std::uint8_t code(double share) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * kFull));
}

/// K = 1 - max(R, G, B); C, M and Y are the rest of the colour, as a share of 1 - K (section 4.3).
void plain_cmyk(const std::uint8_t* rgb, std::size_t count, std::uint8_t* out) {
  for (std::size_t i = 0; i < count; ++i, rgb += 3, out += 4) {
    const int most = std::max({rgb[0], rgb[1], rgb[2]});
    for (int c = 0; c < 3; ++c)
      out[c] = most == 0 ? 0 : code(1 - static_cast<double>(rgb[c]) / most);
    out[3] = static_cast<std::uint8_t>(255 - most);
  }
}

void convert(const ink::PrinterColours& colours, const std::uint8_t* rgb, std::size_t count,
             std::uint8_t* out) {
  std::vector<std::uint16_t> wide(count * static_cast<std::size_t>(colours.channels()));
  colours.convert(rgb, count, wide.data());
  // Divides by 257, because 65535 = 257 * 255.
  std::transform(wide.begin(), wide.end(), out, [](std::uint16_t value) {
    return static_cast<std::uint8_t>((value + 128) / 257);
  });
}

/// Sets white pixels to no ink: white film carries none, and white paper needs none.
void keep_white(const std::uint8_t* rgb, std::size_t count, int channels, std::uint8_t* out) {
  const std::uint8_t nothing = channels == 4 ? 0 : 255;
  for (std::size_t i = 0; i < count; ++i, rgb += 3, out += channels) {
    if (rgb[0] == 255 && rgb[1] == 255 && rgb[2] == 255) std::fill(out, out + channels, nothing);
  }
}

int total(const std::uint8_t* cmyk) { return cmyk[0] + cmyk[1] + cmyk[2] + cmyk[3]; }

/// Effect of the ink limit on a row.
struct Limited {
  int most = 0;  ///< largest sum of a pixel's channels after the limit, out of 4 * 255
  std::size_t changed = 0;
};

Limited limit_ink(std::uint8_t* cmyk, std::size_t count, int most) {
  HP_CHECK(most >= 0);
  Limited out;
  for (std::size_t i = 0; i < count; ++i, cmyk += 4) {
    if (total(cmyk) > most) {
      ++out.changed;
      cmyk[3] = static_cast<std::uint8_t>(std::min<int>(cmyk[3], most));
      const int colour = cmyk[0] + cmyk[1] + cmyk[2];
      for (int c = 0; c < 3; ++c) {  // rounded down, so that the sum stays within the limit
        cmyk[c] = static_cast<std::uint8_t>(colour > 0 ? cmyk[c] * (most - cmyk[3]) / colour : 0);
      }
    }
    out.most = std::max(out.most, total(cmyk));
  }
  return out;
}

Status check_limit(double ink_limit) {
  if (ink_limit > 0 && ink_limit <= ink::kMostInk) return {};
  return fail(
      Code::kOutOfRange,
      fmt::format(
          "ink limit: {} is out of range. Use a limit of C + M + Y + K above 0 and at most {}",
          ink_limit, ink::kMostInk));
}

/// Returns the conversion for the settings. Sets the number of channels and the profile of `out`.
Result<Convert> converter(const ColourSettings& settings, PrinterColoured& out) {
  if (!settings.icc_profile.empty()) {
    HP_ASSIGN_OR_RETURN(const auto colours, ink::PrinterColours::open(settings.icc_profile));
    out.icc_profile = colours.icc_profile();
    out.image.channels = colours.channels();
    return Convert([colours](const std::uint8_t* rgb, std::size_t count, std::uint8_t* to) {
      convert(colours, rgb, count, to);
    });
  }
  out.image.channels = settings.cmyk ? 4 : 3;
  if (settings.cmyk) return Convert(plain_cmyk);
  return Convert([](const std::uint8_t* rgb, std::size_t count, std::uint8_t* to) {
    std::copy(rgb, rgb + 3 * count, to);
  });
}

}  // namespace

Result<PrinterColoured> printer_coloured(const image::RgbImage& image,
                                         const ColourSettings& settings, const Context& context) {
  HP_RETURN_IF_ERROR(check_limit(settings.ink_limit));
  PrinterColoured out;
  HP_ASSIGN_OR_RETURN(const Convert convert_row, converter(settings, out));
  image::PrinterImage& to = out.image;
  if (to.channels == 3 && settings.ink_limit < ink::kMostInk) {
    return fail(Code::kInvalidArgument,
                "ink limit: does not apply to RGB. Print in CMYK, or remove the limit");
  }
  to.width = image.width;
  to.height = image.height;
  to.samples.resize(to.row_bytes() * static_cast<std::size_t>(to.height));
  const int most = static_cast<int>(settings.ink_limit * kFull);
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<Limited> rows(static_cast<std::size_t>(image.height));
  HP_RETURN_IF_ERROR(parallel_for(context, "colours", rows.size(), [&](std::size_t row) -> Status {
    const auto y = static_cast<int>(row);
    convert_row(image.at(0, y), width, to.at(0, y));
    keep_white(image.at(0, y), width, to.channels, to.at(0, y));
    if (to.channels == 4) rows[row] = limit_ink(to.at(0, y), width, most);
    return {};
  }));
  std::size_t changed = 0;
  for (const Limited& row : rows) {
    changed += row.changed;
    out.most_ink = std::max(out.most_ink, row.most / kFull);
  }
  out.limited_share = static_cast<double>(changed) / static_cast<double>(width * rows.size());
  return out;
}

}  // namespace hydroprint::print
