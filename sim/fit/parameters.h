#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"
#include "sim/film/profile.h"

namespace hydroprint::fit {

/// The parameters of a film profile that can be fitted.
enum class Parameter { kInkRatio, kDrag, kSwellingX, kSwellingY };

inline constexpr std::array<Parameter, 4> kAllParameters = {
    Parameter::kInkRatio, Parameter::kDrag, Parameter::kSwellingX, Parameter::kSwellingY};

/// Description of a parameter for the fit. Parameters are fitted as scaled values: 0 and 1 are the
/// ends of the plausible range, so an uncertainty of 1 means that nothing is known about the
/// parameter.
struct Description {
  std::string name;       ///< "ink_ratio_mm", "drag_length_mm", "swelling_x", "swelling_y"
  std::string plausible;  ///< the plausible range as text, in the units of the profile
  double least = 0;       ///< lower bound, scaled: always 0
  double most = 0;        ///< upper bound that a profile may have, scaled
  double step = 0;        ///< step size for derivatives, scaled
};

/// @param profile  its film thickness is the scale of the ink ratio
[[nodiscard]] Description describe(Parameter parameter, const film::Profile& profile);

/// Returns the parameter's scaled value in a profile. Drag is scaled from 1 / drag_length^2, which
/// is 0 without drag; near 0 the film's motion depends on it smoothly.
[[nodiscard]] double scaled_value(Parameter parameter, const film::Profile& profile);

/// Sets the parameter to a scaled value.
void set_scaled(Parameter parameter, double scaled, film::Profile& profile);

/// Returns the parameter in the units of the profile: ink_ratio_mm, drag_length_mm (infinite
/// without drag) or one component of the swelling.
[[nodiscard]] double natural_value(Parameter parameter, double scaled,
                                   const film::Profile& profile);

/// Parses the names of option `--free`: ink_ratio, drag, swelling (both components); an empty list
/// means all. Error: kInvalidArgument for other names.
[[nodiscard]] Result<std::vector<Parameter>> parse_parameters(
    const std::vector<std::string>& names);

}  // namespace hydroprint::fit
