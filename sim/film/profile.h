#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "sim/base/result.h"

namespace hydroprint::film {

/// What is known of a film and of how it is used (field notes 1 and 4): a TOML file, all keys
/// optional, unknown keys refused.
struct Profile {
  double thickness_mm = 0.5;          ///< of the film without ink (paper section 7)
  double ink_ratio_mm = 0.05;         ///< thickness added per unit of ink amount t (section 4.3)
  Eigen::Vector2d swelling = {1, 1};  ///< printed (x, y) floats at (s_x x, s_y y); each >= 1
  double drag_length_mm = 0;          ///< sqrt(mu h0 / k); 0: no water drag
  double tear_stretch = 3;            ///< film stretched beyond this tears
  double wrinkle_stretch = 0.6;       ///< smaller singular value below this wrinkles
  double activator_ml_per_m2 = 16;
  double soak_s = 60;
  double activator_wait_s = 20;
};

/// Reads and checks a profile. Refuses, naming file, line and remedy: unknown keys, wrong types,
/// values out of range.
[[nodiscard]] Result<Profile> read_profile(const std::filesystem::path& path);

}  // namespace hydroprint::film
