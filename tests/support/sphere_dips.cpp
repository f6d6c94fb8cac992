#include "tests/support/sphere_dips.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/pipeline/dip.h"
#include "sim/validate/regions.h"

namespace hydroprint::testing {

using Eigen::Vector2d;

pipeline::DipOptions sphere_options(const std::string& film, double radius_mm, double theta_deg) {
  pipeline::DipOptions options;
  options.outline = film::parse_outline(film).value();
  options.depth_mm = radius_mm * (1 - std::cos((theta_deg + 1) * validate::kDegree));
  options.map.make_tiles = false;
  return options;
}

pipeline::DipOptions off_centre_options(pipeline::FilmModel model) {
  pipeline::DipOptions options = sphere_options("A4", kOffCentreRadius_mm, 120);
  options.film_model = model;
  options.X_FO = Pose(Eigen::Translation3d(25, -40, 0));
  return options;
}

void scale_mesh(pipeline::DipOptions& options, double factor) {
  options.mesh.size.at_waterline_mm *= factor;
  options.mesh.size.growth *= factor;
  options.mesh.size.most_mm *= factor;
  options.mesh.spacing_mm *= factor;
  options.mesh.tolerance_mm *= factor * factor;
}

void scale_all(pipeline::DipOptions& options, double factor) {
  scale_mesh(options, factor);
  options.schedule.swept_mm *= factor;
  options.sheet.tolerance_mm *= factor * factor;
  if (factor < 1) options.sheet.most_sweeps += 4;
}

std::vector<double> landing_distances_mm(const pipeline::Dip& dip, double radius_mm,
                                         const ContactAngle& contact_angle_rad) {
  std::vector<double> distances(dip.surface.points.size(),
                                std::numeric_limits<double>::quiet_NaN());
  for (std::size_t v = 0; v < distances.size(); ++v) {
    const Vector2d& film = dip.map.surface.film_mm[v];
    if (!film.allFinite()) continue;
    const Vector2d flat = dip.surface.points[v].head<2>();
    const double theta = validate::theta_deg(dip.surface.points[v]) * validate::kDegree;
    const double along = contact_angle_rad(film.norm()) - theta;
    const double turn = flat.norm() < 1e-9 || film.norm() < 1e-9
                            ? 0
                            : std::atan2(flat.x() * film.y() - flat.y() * film.x(), flat.dot(film));
    distances[v] = radius_mm * std::hypot(along, std::sin(theta) * turn);
  }
  return distances;
}

Errors errors_to(double theta_deg, const mesh::Surface& surface,
                 const std::vector<double>& errors_mm) {
  const std::vector<double> there =
      validate::values_where(surface, errors_mm, validate::band(0, theta_deg, "").region);
  Errors out;
  out.summary = validate::summarise(there);
  out.missing = there.size() - out.summary.count;
  return out;
}

Result<MeshSlope> mesh_slope(const mesh::Model& model, pipeline::DipOptions options,
                             const Context& context) {
  // Small, because the residual of the sheet's sweeps does not decrease with the mesh size.
  options.sheet.tolerance_mm = 1e-4;
  options.sheet.most_sweeps = 20;
  const auto with_mesh = [&](double factor) {
    pipeline::DipOptions scaled = options;
    scale_mesh(scaled, factor);
    return pipeline::dip(model, scaled, context);
  };
  HP_ASSIGN_OR_RETURN(const pipeline::Dip finest, with_mesh(0.4));
  const auto error = [&](double factor) -> Result<double> {
    HP_ASSIGN_OR_RETURN(const pipeline::Dip dip, with_mesh(factor));
    return errors_to(120, dip.surface, validate::film_differences(dip, finest)).summary.rms;
  };
  MeshSlope out;
  HP_ASSIGN_OR_RETURN(out.rms_mm_at_4, error(4));
  HP_ASSIGN_OR_RETURN(out.rms_mm_at_2, error(2));
  HP_ASSIGN_OR_RETURN(out.rms_mm_at_1, error(1));
  out.slope =
      std::log2(out.rms_mm_at_4 / out.rms_mm_at_1) / 2;  // least-squares line through three points
  return out;
}

}  // namespace hydroprint::testing
