#include "sim/fit/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hydroprint::fit {
namespace {

/// Upper end of the plausible range of drag (1 / drag_length^2): a length of 10 mm. The lower end
/// is 0.
constexpr double kPlausibleDrag_per_mm2 = 0.01;
/// Maximum drag: a length of 1 mm.
constexpr double kMostDrag_per_mm2 = 1;
/// Maximum drag length. Longer ones make no difference, and profiles do not allow them.
constexpr double kLongestDrag_mm = 1e4;
/// Upper end of the plausible range of swelling minus 1. Above a swelling of 1.3, prints are
/// blurred.
constexpr double kPlausibleGrowth = 0.3;
constexpr double kMostGrowth = 1;
constexpr double kMostInk_mm = 10;

int axis_of(Parameter parameter) { return parameter == Parameter::kSwellingY ? 1 : 0; }

double range_of(Parameter parameter, const film::Profile& profile) {
  switch (parameter) {
    case Parameter::kInkRatio:
      return profile.thickness_mm;
    case Parameter::kDrag:
      return kPlausibleDrag_per_mm2;
    case Parameter::kSwellingX:
    case Parameter::kSwellingY:
      return kPlausibleGrowth;
  }
  return 1;
}

}  // namespace

Description describe(Parameter parameter, const film::Profile& profile) {
  const double range = range_of(parameter, profile);
  if (parameter == Parameter::kInkRatio) {
    return {"ink_ratio_mm",
            fmt::format("0 to {} mm, the film's own thickness", profile.thickness_mm), 0,
            kMostInk_mm / range, 0.03};
  }
  if (parameter == Parameter::kDrag) {
    return {"drag_length_mm", "no drag to a drag length of 10 mm", 0, kMostDrag_per_mm2 / range,
            0.01};
  }
  return {parameter == Parameter::kSwellingX ? "swelling_x" : "swelling_y", "1 to 1.3", 0,
          kMostGrowth / range, 0.03};
}

double scaled_value(Parameter parameter, const film::Profile& profile) {
  const double range = range_of(parameter, profile);
  switch (parameter) {
    case Parameter::kInkRatio:
      return profile.ink_ratio_mm / range;
    case Parameter::kDrag: {
      const double length_mm = profile.drag_length_mm;
      if (length_mm <= 0) return 0;
      return std::min(1 / (length_mm * length_mm), kMostDrag_per_mm2) / range;
    }
    case Parameter::kSwellingX:
    case Parameter::kSwellingY:
      return (profile.swelling[axis_of(parameter)] - 1) / range;
  }
  return 0;
}

void set_scaled(Parameter parameter, double scaled, film::Profile& profile) {
  const double value = natural_value(parameter, scaled, profile);
  switch (parameter) {
    case Parameter::kInkRatio:
      profile.ink_ratio_mm = value;
      return;
    case Parameter::kDrag:
      profile.drag_length_mm = std::isfinite(value) ? value : 0;
      return;
    case Parameter::kSwellingX:
    case Parameter::kSwellingY:
      profile.swelling[axis_of(parameter)] = value;
      return;
  }
}

double natural_value(Parameter parameter, double scaled, const film::Profile& profile) {
  const double value = scaled * range_of(parameter, profile);
  switch (parameter) {
    case Parameter::kInkRatio:
      return std::min(value, kMostInk_mm);
    case Parameter::kDrag:
      return value > 1 / (kLongestDrag_mm * kLongestDrag_mm)
                 ? 1 / std::sqrt(value)
                 : std::numeric_limits<double>::infinity();
    case Parameter::kSwellingX:
    case Parameter::kSwellingY:
      return 1 + std::min(value, kMostGrowth);
  }
  return value;
}

Result<std::vector<Parameter>> parse_parameters(const std::vector<std::string>& names) {
  if (names.empty()) return std::vector<Parameter>(kAllParameters.begin(), kAllParameters.end());
  std::array<bool, kAllParameters.size()> is_free{};
  for (const std::string& name : names) {
    if (name == "ink_ratio") {
      is_free[0] = true;
    } else if (name == "drag") {
      is_free[1] = true;
    } else if (name == "swelling") {
      is_free[2] = is_free[3] = true;
    } else {
      return fail(Code::kInvalidArgument,
                  "'" + name + "' cannot be fitted. Use ink_ratio, drag or swelling");
    }
  }
  std::vector<Parameter> out;
  for (std::size_t i = 0; i < is_free.size(); ++i) {
    if (is_free[i]) out.push_back(kAllParameters[i]);
  }
  return out;
}

}  // namespace hydroprint::fit
