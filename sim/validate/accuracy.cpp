#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "sim/film/outline.h"
#include "sim/image/figures/pictures.h"
#include "sim/pipeline/dip.h"
#include "sim/validate/experiments.h"
#include "sim/validate/measure.h"
#include "sim/validate/regions.h"

namespace hydroprint::validate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

bool is_whole(double x) { return std::abs(x - std::round(x)) < 1e-6; }

/// Returns true at the cross-points of the board's lines, which are 10 mm apart.
bool is_board_cross(const Vector3d& p) {
  return is_whole(p.x() / 10) && is_whole(p.y() / 10) && is_whole(p.z() / 10);
}

/// Returns true at the cross-points of the sphere's meridians and parallels, which are 15 degrees
/// apart.
bool is_sphere_cross(const Vector3d& p) {
  return is_whole(theta_deg(p) / 15) && is_whole(std::atan2(p.y(), p.x()) / (15 * kDegree));
}

/// Returns a table of the errors at the cross-points and at all points, with a row for each region.
Table error_table(const std::string& caption, const mesh::Surface& surface,
                  const std::vector<double>& errors, const Region& is_cross,
                  const std::vector<std::pair<NamedRegion, std::string>>& regions) {
  Table table{caption,
              {"region", "cross-points", "mean, mm", "largest, mm", "all points: rms, mm",
               "largest, mm", "does not land", "measured in the paper"},
              {}};
  for (const auto& [named, paper] : regions) {
    const Region& region = named.region;
    const Summary cross = summarise(
        values_where(surface, errors, [&](const Vector3d& p) { return region(p) && is_cross(p); }));
    const Summary all = summarise(values_where(surface, errors, region));
    const double lost =
        share_where(surface, region, [&](std::size_t v) { return std::isinf(errors[v]); });
    table.rows.push_back({named.name, std::to_string(cross.count), text_of(cross.mean, 4),
                          text_of(cross.max, 3), text_of(all.rms, 4), text_of(all.max, 3),
                          text_of(100 * lost, 2) + " %", paper});
  }
  return table;
}

/// Returns the largest error at the cross-points of a region.
double worst(const mesh::Surface& surface, const std::vector<double>& errors,
             const Region& is_cross, const Region& region) {
  return summarise(values_where(surface, errors,
                                [&](const Vector3d& p) { return region(p) && is_cross(p); }))
      .max;
}

/// @param body  its name, and the region whose errors determine the error picture's scale
Status show(const ExperimentContext& setup, Experiment& out, const NamedRegion& body,
            const Plan& plan, const pipeline::Dip& truth, const std::vector<double>& errors,
            const Context& context) {
  const std::string& name = body.name;
  HP_ASSIGN_OR_RETURN(const auto film, setup.texture(plan.film, context));
  HP_RETURN_IF_ERROR(
      setup.show(out, name + "-film", plan.film,
                 "The film image for the " + name + ", A4, computed at the usual settings."));
  HP_ASSIGN_OR_RETURN(const auto landed,
                      image::find_views(truth.surface, truth.X_FO, truth.map.tiles, context));
  HP_RETURN_IF_ERROR(setup.show(out, name + "-landed",
                                image::predicted_picture(landed, film, context),
                                "The same film image as it lands in the fine computation."));
  const pipeline::Dip& dip = plan.dip;
  HP_ASSIGN_OR_RETURN(const auto planned,
                      image::find_views(dip.surface, dip.X_FO, dip.map.tiles, context));
  return setup.show(
      out, name + "-error",
      image::quantity_picture(planned, quantity_of("error mm", dip.surface, errors, body.region),
                              context),
      "Distance on the object between where a colour should be and where it lands.");
}

Status board(ExperimentContext& setup, Experiment& out, Steps& steps) {
  const Context context = steps.next();
  HP_ASSIGN_OR_RETURN(const Plan* plan, setup.plan("board", context));
  const Context fine = steps.next();
  HP_ASSIGN_OR_RETURN(const pipeline::Dip truth, setup.experiment("board", fine));
  const mesh::Surface& surface = plan->dip.surface;
  HP_ASSIGN_OR_RETURN(const auto errors, landing_errors(plan->dip, truth, fine));
  const Region lower = [](const Vector3d& p) { return p.z() < 1e-6; };
  const Region sides = [](const Vector3d& p) { return p.z() > 1e-6 && p.z() < 10 - 1e-6; };
  const Region upper = [](const Vector3d& p) { return p.z() > 10 - 1e-6; };
  out.tables.push_back(error_table("The board, 120 x 120 x 10 mm, dipped at 30 degrees", surface,
                                   errors, is_board_cross,
                                   {{{"lower face", lower}, "at most 1.5 mm"},
                                    {{"sides", sides}, "-"},
                                    {{"upper face, 150 degrees to the water", upper}, "-"}}));
  out.figures.push_back({"board_lower_face_max_mm",
                         "board, lower face: largest error at a cross-point", "mm",
                         worst(surface, errors, is_board_cross, lower),
                         Limit{0, 1.5, "total error measured in the paper"}});
  const Region scale = [](const Vector3d& p) { return p.z() < 10 - 1e-6; };
  return show(setup, out, {"board", scale}, *plan, truth, errors, fine);
}

Status sphere(ExperimentContext& setup, Experiment& out, Steps& steps) {
  const Context context = steps.next();
  HP_ASSIGN_OR_RETURN(const Plan* plan, setup.plan("sphere80", context));
  const Context fine = steps.next();
  HP_ASSIGN_OR_RETURN(const pipeline::Dip truth, setup.experiment("sphere80", fine));
  const mesh::Surface& surface = plan->dip.surface;
  HP_ASSIGN_OR_RETURN(const auto errors, landing_errors(plan->dip, truth, fine));
  const NamedRegion half = band(0, 90, "to the equator");
  const NamedRegion next = band(90, 120, "90 to 120 degrees");
  out.tables.push_back(
      error_table("The sphere of radius 80 mm, by the angle of its surface to the water", surface,
                  errors, is_sphere_cross,
                  {{half, "at most 2 mm"},
                   {next, "-"},
                   {band(120, 150, "120 to 150 degrees"), "-"},
                   {band(150, 180, "150 to 180 degrees, the far pole"), "about 5 mm"}}));
  out.figures.push_back({"sphere_to_equator_max_mm",
                         "sphere, to the equator: largest error at a cross-point", "mm",
                         worst(surface, errors, is_sphere_cross, half.region),
                         Limit{0, 2, "total error measured in the paper"}});
  out.figures.push_back({"sphere_to_120_deg_max_mm",
                         "sphere, 90 to 120 degrees: largest error at a cross-point", "mm",
                         worst(surface, errors, is_sphere_cross, next.region), std::nullopt});
  out.figures.push_back(
      {"sphere_far_pole_max_mm", "sphere, 150 degrees and more: largest error at a cross-point",
       "mm", worst(surface, errors, is_sphere_cross, band(150, 180, "").region), std::nullopt});
  return show(setup, out, {"sphere80", band(0, 120, "").region}, *plan, truth, errors, fine);
}

/// Returns the landing point of a film point on a sphere of radius R dipped in the middle of a
/// circular film of radius Rv: the exact solution of eqs. (1) and (2), and of the sheet of uniform
/// thickness, solved for theta.
Vector3d exact_landing(const Vector2d& film_mm, double R, double Rv) {
  const double k = std::sqrt(Rv * Rv / (R * R) - 1);
  const double r0 = film_mm.norm();
  const double cosine = k * std::tan(std::atan(1 / k) + 0.5 * k * std::log1p(-r0 * r0 / (Rv * Rv)));
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const Vector2d direction = r0 > 0 ? Vector2d(film_mm / r0) : Vector2d(1, 0);
  return {R * sine * direction.x(), R * sine * direction.y(), -R * cosine};
}

Result<double> distance_from_exact(ExperimentContext& setup, Fineness fineness,
                                   const Context& context) {
  constexpr double kFilm_mm = 105;
  HP_ASSIGN_OR_RETURN(const Body* body, setup.body("sphere80", context));
  pipeline::DipOptions options = setup.options(*body, fineness);
  HP_ASSIGN_OR_RETURN(options.outline, film::parse_outline("circle:105"));
  options.map.make_tiles = false;
  options.film_model = pipeline::FilmModel::kStokes;
  HP_ASSIGN_OR_RETURN(const pipeline::Dip dip, pipeline::dip(body->model, options, context));
  std::vector<double> errors;
  for (std::size_t v = 0; v < dip.surface.points.size(); ++v) {
    const Vector3d& p = dip.surface.points[v];
    const Vector2d& film = dip.map.surface.film_mm[v];
    if (theta_deg(p) > 120 || !film.allFinite()) continue;
    errors.push_back((exact_landing(film, kSphere80_mm, kFilm_mm) - p).norm());
  }
  return summarise(std::move(errors)).max;
}

Status exact(ExperimentContext& setup, Experiment& out, Steps& steps) {
  const Context usual_context = steps.next();
  HP_ASSIGN_OR_RETURN(const double usual,
                      distance_from_exact(setup, Fineness::kUsual, usual_context));
  const Context fine_context = steps.next();
  HP_ASSIGN_OR_RETURN(const double fine, distance_from_exact(setup, Fineness::kFine, fine_context));
  // Errors grow with the square of the lengths.
  const double looser = setup.quick() ? kQuickFactor * kQuickFactor : 1;
  const std::string quick = setup.quick() ? ", times 6.25 for the coarse quick run" : "";
  out.figures.push_back({"exact_sphere_usual_max_mm",
                         "the same sphere in a circular film, to 120 degrees, usual settings: "
                         "largest distance from the exact solution",
                         "mm", usual,
                         Limit{0, 0.2 * looser, "a tenth of the paper's measured error" + quick}});
  out.figures.push_back({"exact_sphere_fine_max_mm", "the same at the fine settings", "mm", fine,
                         Limit{0, 0.05 * looser, "target for the film mesh" + quick}});
  return {};
}

}  // namespace

Status accuracy(ExperimentContext& setup, Experiment& out, const Context& context) {
  out.text = {
      "As in the paper, a film image is computed so that the cross-points of a grid land on known "
      "places of the object (shallow dimples in the paper). Then it is dipped. The film image is "
      "computed at the usual settings. The dip is computed with all lengths (of the film mesh, of "
      "the steps in depth, of the tolerances) 0.6 times as long. The error is the distance from "
      "each cross-point to its place. The maps show the error of every point of the surface.",
      "This is the error of the computation alone. The paper's figures also include all effects on "
      "a real film. Most of the error is not due to the mesh. The film image is computed for the "
      "ink of the previous image (one pass of the two-step scheme, as in the paper), so the "
      "thickness of the dipped film differs slightly from the computed one.",
      "The fine computation is checked against an exact solution: a sphere in the middle of a "
      "circular film, with Stokes flow (the sheet has the same solution there). The remaining "
      "error at the fine settings is mostly due to the approximation of the sphere by "
      "triangles."};
  Steps steps(context, out.name, 6);
  HP_RETURN_IF_ERROR(board(setup, out, steps));
  HP_RETURN_IF_ERROR(sphere(setup, out, steps));
  return exact(setup, out, steps);
}

}  // namespace hydroprint::validate
