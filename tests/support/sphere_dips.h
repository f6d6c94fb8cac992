#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/pipeline/pipeline.h"
#include "sim/validate/measure.h"

/// Dips of spheres, whose maps are known or can be compared, for tests and benchmarks.
namespace hydroprint::testing {

/// A dip at the default settings until one degree past `theta_deg`; the map without tiles, as
/// `simulate --artifacts map` makes it.
[[nodiscard]] pipeline::DipOptions sphere_options(const std::string& film, double radius_mm,
                                                  double theta_deg);

/// The dip of the off-centre rows, to 120 degrees: radius 45 mm at (25, -40) mm on A4.
inline constexpr double kOffCentreRadius_mm = 45;
[[nodiscard]] pipeline::DipOptions off_centre_options(pipeline::FilmModel model);

/// Every length by which the film is meshed times `factor`.
void scale_mesh(pipeline::DipOptions& options, double factor);

/// The order in which the error of a dip falls with the lengths of its mesh: that of the film
/// points of vertices to 120 degrees from a mesh of 0.4 times the lengths, over lengths from four
/// times to once, steps and all else being the same.
struct MeshSlope {
  double slope = 0;
  double rms_mm_at_4 = 0, rms_mm_at_2 = 0, rms_mm_at_1 = 0;
};
[[nodiscard]] Result<MeshSlope> mesh_slope(const mesh::Model& model, pipeline::DipOptions options,
                                           const Context& context);

/// All that a dip is divided into times `factor`: steps, mesh and, of second order, tolerances.
void scale_all(pipeline::DipOptions& options, double factor);

/// Contact angle at which the film of a radius lands; NaN where it does not.
using ContactAngle = std::function<double(double film_mm)>;

/// Per point of the surface of a centred sphere: the distance on the sphere between it and the
/// place where the film found for it lands by a known map; NaN where no film was found.
[[nodiscard]] std::vector<double> landing_distances_mm(const pipeline::Dip& dip, double radius_mm,
                                                       const ContactAngle& contact_angle_rad);

/// Errors up to a contact angle.
struct Errors {
  validate::Summary summary;
  std::size_t missing = 0;  ///< points without film
};
[[nodiscard]] Errors errors_to(double theta_deg, const mesh::Surface& surface,
                               const std::vector<double>& errors_mm);

}  // namespace hydroprint::testing
