#pragma once

namespace hydroprint::exact {

/// Exact maps of a centred sphere (field notes, section 2), for Stokes flow and the uniform sheet.

/// Film radius that lands at contact angle `theta_rad`, measured from the lowest point, in a
/// circular film of radius `vat_mm`.
[[nodiscard]] double film_radius_mm(double sphere_mm, double vat_mm, double theta_rad);

/// Inverse of film_radius_mm(): contact angle at which the film of radius `film_mm` lands.
[[nodiscard]] double contact_angle_rad(double sphere_mm, double vat_mm, double film_mm);

}  // namespace hydroprint::exact
