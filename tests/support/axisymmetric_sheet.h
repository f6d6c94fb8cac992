#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

/// The quasistatic viscous sheet (section 4.3; field notes, section 1) in one dimension: a body of
/// revolution sinks through the centre of a circular film whose thickness depends on the radius.
/// It is the reference for the simulation and shares no code with it. axisymmetric_sheet.cpp
/// derives the equations.
namespace hydroprint::axisymmetric {

struct Film {
  double vat_mm = 0;  ///< radius at which the film is clamped
  /// Thickness of the film at rest [mm] by radius at rest [mm].
  std::function<double(double)> thickness_mm;
  double base_thickness_mm = 0;  ///< the thickness that drag_length_mm refers to
  double drag_length_mm = 0;     ///< sqrt(viscosity * base thickness / drag); 0 for no drag
};

/// A body of revolution, tip down. Areas here are per radian: wetted area / 2 pi.
struct Body {
  /// Cosine of the contact angle as a function of the wetted area.
  std::function<double(double)> cos_theta;
  double end_mm2 = 0;  ///< the wetted area at which the dip ends
};

/// A sphere dipped to the contact angle `theta_rad`, at most 170 degrees. Beyond it, eq. (1) is
/// clamped, which is not modelled.
[[nodiscard]] Body sphere(double radius_mm, double theta_rad);

/// A cone whose surface rises at `slope_rad` from its tip, dipped to the radius `waterline_mm`.
[[nodiscard]] Body cone(double slope_rad, double waterline_mm);

/// Wetted area per radian of a sphere when the waterline is at `theta_rad`.
[[nodiscard]] double sphere_wetted_mm2(double radius_mm, double theta_rad);

/// A ring of film at the moment when it sticks.
struct Landing {
  double film_mm = 0;       ///< radius at rest
  double waterline_mm = 0;  ///< radius now, from the tracked film; ideally that of the waterline
  double wetted_mm2 = 0;    ///< area per radian wetted before the ring sticks
  double contact_angle_rad = 0;
  double area_stretch = 1;  ///< area now / area at rest
  double thickness_mm = 0;  ///< thickness now
};

/// A dip from first contact to the body's `end_mm2`, or to the point where the film is nearly used
/// up.
class Dip {
 public:
  /// Divides the film into `rings` rings of equal width. The error is of second order in this
  /// width, or of fourth order for a uniform film without drag.
  Dip(const Film& film, const Body& body, int rings);

  /// Landings of every second ring, from the centre outwards; the last may be past the body's end.
  [[nodiscard]] const std::vector<Landing>& landings() const { return landings_; }

  /// The landing after `wetted_mm2` per radian has been wetted; nullopt past the end.
  [[nodiscard]] std::optional<Landing> at_wetted(double wetted_mm2) const;

  /// The landing of the film of radius `film_mm`; nullopt past the end.
  [[nodiscard]] std::optional<Landing> at_film(double film_mm) const;

 private:
  Film film_;
  Body body_;
  std::vector<Landing> landings_;
};

/// Radius times radial velocity at rings. `q` [mm^2] is half the squared radius of each ring,
/// ascending. The first
/// ring moves with `at_waterline`, and the last is clamped. `volume` [mm^3] is the film's volume
/// between a ring and the next, per radian; `drag_per_mm` is drag / viscosity.
[[nodiscard]] std::vector<double> flux(std::span<const double> q, std::span<const double> volume,
                                       double at_waterline, double drag_per_mm);

}  // namespace hydroprint::axisymmetric
