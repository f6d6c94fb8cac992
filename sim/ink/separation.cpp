#include "sim/ink/separation.h"

#include <algorithm>
#include <array>
#include <memory>

#include "sim/ink/printer_colours.h"

namespace hydroprint::ink {
namespace {

void naive_cmyk(const std::uint8_t* rgb, std::size_t count, double* t) {
  // K + (C + M + Y) = 1 - max + (3 (1 - K) - (R + G + B)) / (1 - K), where 1 - K = max.
  for (std::size_t i = 0; i < count; ++i, rgb += 3) {
    const int most = std::max({rgb[0], rgb[1], rgb[2]});
    const int sum = rgb[0] + rgb[1] + rgb[2];
    t[i] = most == 0 ? 1 : 4 - most / 255.0 - static_cast<double>(sum) / most;
  }
}

}  // namespace

Result<Separation> make_separation(const std::filesystem::path& icc_profile) {
  if (icc_profile.empty()) return Separation(naive_cmyk);
  HP_ASSIGN_OR_RETURN(const PrinterColours colours, PrinterColours::open(icc_profile));
  if (colours.channels() != 4) {
    return fail(Code::kInvalidArgument,
                icc_profile.string() +
                    ": not the profile of a CMYK printer. Use an ICC output profile whose colour "
                    "space is CMYK");
  }
  return Separation([colours](const std::uint8_t* rgb, std::size_t count, double* t) {
    constexpr std::size_t kPart = 1024;
    std::array<std::uint16_t, 4 * kPart> cmyk;
    for (std::size_t from = 0; from < count; from += kPart) {
      const std::size_t part = std::min(kPart, count - from);
      colours.convert(rgb + 3 * from, part, cmyk.data());
      for (std::size_t i = 0; i < part; ++i) {
        const std::uint16_t* c = &cmyk[4 * i];
        t[from + i] = (c[0] + c[1] + c[2] + c[3]) / 65535.0;
      }
    }
  });
}

}  // namespace hydroprint::ink
