#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::film {

/// Properties of a film and of its use (field notes 1 and 4), read from a TOML file. All keys are
/// optional; unknown keys are errors. deploy/film_profile.toml.example describes each key.
struct Profile {
  double thickness_mm = 0.5;   ///< thickness of the film without ink (paper section 7)
  double ink_ratio_mm = 0.05;  ///< thickness added per unit of ink amount t (section 4.3)
  /// The printer's ICC output profile (CMYK), which converts colours to ink; empty: plain CMYK. A
  /// relative path in the file is relative to the folder of the file.
  std::filesystem::path ink_icc_profile;
  Eigen::Vector2d swelling = {1, 1};  ///< printed (x, y) floats at (s_x x, s_y y); each >= 1
  double drag_length_mm = 0;          ///< sqrt(mu h0 / k); 0: no water drag
  double tear_stretch = 3;            ///< film stretched beyond this factor tears
  double wrinkle_stretch = 0.6;       ///< film whose smaller singular value is below this wrinkles
  /// Material properties of the film (paper section 7), used only by the inertial step. In the
  /// quasistatic solution the velocity is prescribed along the film's whole boundary, so Y and rho
  /// have no effect, and nu is 0.5, because volume is conserved (field notes 1).
  double young_modulus_mpa = 1.82;
  double density_kg_per_m3 = 1300;
  double poisson_ratio = 0.5;
  double activator_ml_per_m2 = 16;
  double soak_s = 60;
  double activator_wait_s = 20;
};

/// Reads and checks a profile. Returns an error, with file, line and remedy, for unknown keys,
/// wrong types and values out of range. The ICC profile itself is checked when it is used.
[[nodiscard]] Result<Profile> read_profile(const std::filesystem::path& path);

/// Returns the profile as TOML from which read_profile() restores exactly the same numbers. The
/// path of the ICC profile is absolute.
[[nodiscard]] std::string profile_toml(const Profile& profile);

/// Returns the thickness at rest, mm, of film that carries the ink amount t in [0, 4]: h0 +
/// ink_ratio t (section 4.3).
[[nodiscard]] double rest_thickness_mm(const Profile& profile, double t);

}  // namespace hydroprint::film
