#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"
#include "sim/film/profile.h"

namespace hydroprint::fit {

/// What a film profile leaves to be fitted.
enum class Parameter { kInkRatio, kDrag, kSwellingX, kSwellingY };

inline constexpr std::array<Parameter, 4> kAllParameters = {
    Parameter::kInkRatio, Parameter::kDrag, Parameter::kSwellingX, Parameter::kSwellingY};

/// What the fit needs to know of a parameter. It is fitted as a scaled value: 0 and 1 are the ends
/// of what is plausible, so that one that is uncertain by 1 is not known at all.
struct Description {
  std::string name;       ///< "ink_ratio_mm", "drag_length_mm", "swelling_x", "swelling_y"
  std::string plausible;  ///< for people: that range, in the profile's terms
  double least = 0;       ///< the film's bound, scaled: always 0
  double most = 0;        ///< the profile's other bound, scaled
  double step = 0;        ///< scaled, by which derivatives are taken
};

/// @param profile  ink is measured by its film's thickness
[[nodiscard]] Description describe(Parameter parameter, const film::Profile& profile);

/// The parameter's scaled value in a profile. Drag is 1 / drag_length^2, which is 0 without drag
/// and in which the film's motion is smooth there.
[[nodiscard]] double scaled_value(Parameter parameter, const film::Profile& profile);

/// Gives the parameter a scaled value.
void set_scaled(Parameter parameter, double scaled, film::Profile& profile);

/// The parameter as the profile has it: ink_ratio_mm, drag_length_mm (infinite without drag) or one
/// component of the swelling.
[[nodiscard]] double natural_value(Parameter parameter, double scaled,
                                   const film::Profile& profile);

/// Reads names as `--free` takes them: ink_ratio, drag, swelling (both of its components); none:
/// all. Refuses (kInvalidArgument) others.
[[nodiscard]] Result<std::vector<Parameter>> parse_parameters(
    const std::vector<std::string>& names);

}  // namespace hydroprint::fit
