#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/pipeline/pipeline.h"
#include "sim/validate/measure.h"

/// Dips of spheres with known or comparable maps, for tests and benchmarks.
namespace hydroprint::testing {

/// Options of a dip at the default settings to one degree past `theta_deg`. The map has no tiles,
/// as with `simulate --artifacts map`.
[[nodiscard]] pipeline::DipOptions sphere_options(const std::string& film, double radius_mm,
                                                  double theta_deg);

/// The sphere of the off-centre benchmark rows: radius 45 mm at (25, -40) mm on A4, dipped to 120
/// degrees.
inline constexpr double kOffCentreRadius_mm = 45;
[[nodiscard]] pipeline::DipOptions off_centre_options(pipeline::FilmModel model);

/// Multiplies all mesh lengths of the film by `factor`.
void scale_mesh(pipeline::DipOptions& options, double factor);

/// Order of a dip's error in its mesh lengths. The errors are rms distances between the film points
/// of vertices up to 120 degrees for mesh lengths multiplied by 4, 2 and 1 and those for lengths
/// multiplied by 0.4. Steps and all other settings are equal.
struct MeshSlope {
  double slope = 0;
  double rms_mm_at_4 = 0, rms_mm_at_2 = 0, rms_mm_at_1 = 0;
};
[[nodiscard]] Result<MeshSlope> mesh_slope(const mesh::Model& model, pipeline::DipOptions options,
                                           const Context& context);

/// Multiplies steps and mesh lengths by `factor`, and tolerances by its square.
void scale_all(pipeline::DipOptions& options, double factor);

/// Contact angle at which film of a given radius lands; NaN if the film does not land.
using ContactAngle = std::function<double(double film_mm)>;

/// For each point on a centred sphere: the distance on the sphere between the point and the place
/// where its computed film point lands according to a known map. NaN if the point has no film.
[[nodiscard]] std::vector<double> landing_distances_mm(const pipeline::Dip& dip, double radius_mm,
                                                       const ContactAngle& contact_angle_rad);

/// Errors of the points up to a contact angle.
struct Errors {
  validate::Summary summary;
  std::size_t missing = 0;  ///< points without film
};
[[nodiscard]] Errors errors_to(double theta_deg, const mesh::Surface& surface,
                               const std::vector<double>& errors_mm);

}  // namespace hydroprint::testing
