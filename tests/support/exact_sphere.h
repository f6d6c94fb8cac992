#pragma once

namespace hydroprint::exact {

/// Exact maps of a centred sphere (field notes, section 2): the film radius that lands at contact
/// angle `theta_rad`, measured from the lowest point, for Stokes flow and for the uniform sheet.

/// In a circular film of radius `vat_mm`.
[[nodiscard]] double film_radius_mm(double sphere_mm, double vat_mm, double theta_rad);

/// Its inverse: the contact angle at which the film of radius `film_mm` lands.
[[nodiscard]] double contact_angle_rad(double sphere_mm, double vat_mm, double film_mm);

}  // namespace hydroprint::exact
