#include "sim/mesh/units.h"

#include <array>
#include <cmath>
#include <limits>

namespace hydroprint::mesh {
namespace {

constexpr double kSmall_mm = 5;
constexpr double kLarge_mm = 1000;
constexpr double kUsual_mm = 150;
constexpr Unit kMetre = {"metres", 1000};
constexpr std::array<Unit, 5> kUnits = {
    {{"micrometres", 0.001}, {"millimetres", 1}, {"centimetres", 10}, {"inches", 25.4}, kMetre}};

bool is_gltf(const std::string& extension) {
  return extension == ".gltf" || extension == ".glb" || extension == ".GLTF" || extension == ".GLB";
}

}  // namespace

bool is_odd_size(double longest_mm) { return longest_mm < kSmall_mm || longest_mm > kLarge_mm; }

std::optional<Unit> likely_unit(double longest, const std::string& extension) {
  if (is_gltf(extension) && !is_odd_size(longest * kMetre.mm)) return kMetre;
  std::optional<Unit> best;
  double least = std::numeric_limits<double>::infinity();
  for (const Unit& unit : kUnits) {
    const double distance = std::abs(std::log(longest * unit.mm / kUsual_mm));
    if (is_odd_size(longest * unit.mm) || !(distance < least)) continue;
    best = unit;
    least = distance;
  }
  return best;
}

}  // namespace hydroprint::mesh
