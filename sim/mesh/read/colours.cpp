#include "sim/mesh/read/colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace hydroprint::mesh {
namespace {

/// Largest value that counts as 1: some programs write light a little brighter than white.
constexpr float kStillUnit = 1.5F;

/// Returns what the values must be divided by.
float full_scale(float largest) {
  if (largest <= kStillUnit) return 1;
  return largest <= 255 ? 255 : 65535;
}

}  // namespace

void bring_to_unit(std::vector<Eigen::Vector3f>& colours, std::string_view what,
                   const std::filesystem::path& path, Warnings& warnings) {
  const auto warn = [&](WarningCode code, std::string message) {
    warnings.push_back({code, std::move(message), {InFile{path.string()}}});
  };
  std::size_t broken = 0;
  float largest = 0;
  for (const auto& colour : colours)
    if (colour.allFinite())
      largest = std::max(largest, colour.maxCoeff());
    else
      ++broken;
  const float scale = full_scale(largest);
  bool clamped = false;
  for (auto& colour : colours) {
    if (!colour.allFinite()) {
      colour.setOnes();
      continue;
    }
    const Eigen::Vector3f unit = colour / scale;
    colour = unit.cwiseMax(0.0F).cwiseMin(1.0F);
    clamped = clamped || colour != unit;
  }
  if (broken > 0)
    warn(WarningCode::COLOURS_NOT_NUMBERS,
         fmt::format("the colours of {} {} are not numbers: they are white", broken, what));
  if (scale > 1)
    warn(WarningCode::COLOURS_SCALED,
         fmt::format(
             "the colours of the {} go from 0 to {} instead of from 0 to 1: they were divided "
             "by {}",
             what, scale, scale));
  if (clamped)
    warn(WarningCode::COLOURS_CLAMPED,
         fmt::format("some colours of the {} are out of range and were limited to it", what));
}

float srgb_of_linear(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return static_cast<float>(c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
}

}  // namespace hydroprint::mesh
