#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/flow/flow_map.h"
#include "sim/flow/trace.h"
#include "sim/mesh/make_surface.h"
#include "sim/pipeline/pipeline.h"
#include "sim/velocity/film_mesh.h"
#include "sim/velocity/velocity.h"
#include "sim/waterline/body.h"
#include "sim/waterline/waterlines.h"

namespace hydroprint::pipeline {
namespace {

constexpr double kSurfaceEdge_mm = 2;  ///< longer faces are subdivided (contract)

/// The film as it floats: swollen, its clamped edge with it.
film::Outline floating(film::Outline outline, const Eigen::Vector2d& swelling) {
  for (Eigen::Vector2d& p : outline.polygon) p = p.cwiseProduct(swelling);
  outline.min_mm = outline.min_mm.cwiseProduct(swelling);
  outline.max_mm = outline.max_mm.cwiseProduct(swelling);
  return outline;
}

/// Stokes has no memory: every waterline is meshed and solved by itself, all in parallel.
Result<std::vector<velocity::VelocityField>> solve(const film::Outline& outline,
                                                   waterline::Waterlines& waterlines,
                                                   const velocity::MeshOptions& options,
                                                   const Context& context) {
  std::vector<velocity::VelocityField> fields(waterlines.lines.size());
  HP_RETURN_IF_ERROR(parallel_for(context, "velocity", fields.size(), [&](std::size_t k) -> Status {
    waterline::Waterline& line = waterlines.lines[k];
    HP_ASSIGN_OR_RETURN(velocity::FilmMesh mesh, velocity::mesh_film(outline, line, options));
    const auto fixed = velocity::boundary_velocities(mesh, line.pulls);
    HP_ASSIGN_OR_RETURN(auto nodes, velocity::solve_stokes(mesh, fixed));
    fields[k] = velocity::VelocityField(std::move(mesh), std::move(nodes));
    line = {line.immersion_mm, {}, {}, {}};  // its curves are not needed any more
    return {};
  }));
  return fields;
}

double area_of(const mesh::Surface& surface, const Eigen::Vector3i& t) {
  const Eigen::Vector3d& a = surface.points[t[0]];
  return 0.5 * (surface.points[t[1]] - a).cross(surface.points[t[2]] - a).norm();
}

void measure(const mesh::Surface& surface, const waterline::Body& body, const flow::SurfaceMap& map,
             DipFigures& figures) {
  double total = 0, reached = 0, clamped = 0;
  std::vector<char> is_clamped(surface.points.size(), 0);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const Eigen::Vector3i& t = surface.triangles[i];
    const double area = area_of(surface, t);
    total += area;
    const auto lands =
        std::count_if(t.begin(), t.end(), [&](int v) { return !std::isnan(map.film_mm[v].x()); });
    reached += area * static_cast<double>(lands) / 3;
    const Eigen::Vector3d& a = body.points_mm[body.triangles[i][0]];
    const Eigen::Vector3d normal = (body.points_mm[body.triangles[i][1]] - a)
                                       .cross(body.points_mm[body.triangles[i][2]] - a)
                                       .normalized();
    if (std::acos(std::clamp(-normal.z(), -1.0, 1.0)) > waterline::kThetaLimit_rad) {
      clamped += area;
      for (const int v : t) is_clamped[v] = 1;
    }
  }
  figures.coverage = total > 0 ? reached / total : 0;
  figures.clamped_share = total > 0 ? clamped / total : 0;
  std::vector<double> stretch;
  for (std::size_t v = 0; v < map.stretch.size(); ++v) {
    if (std::isfinite(map.stretch[v]) && is_clamped[v] == 0) stretch.push_back(map.stretch[v]);
  }
  if (stretch.empty()) return;
  std::sort(stretch.begin(), stretch.end());
  const auto quantile = [&](double q) {
    return stretch[static_cast<std::size_t>(q * static_cast<double>(stretch.size() - 1))];
  };
  figures.stretch_p50 = quantile(0.5);
  figures.stretch_p95 = quantile(0.95);
  figures.stretch_max = stretch.back();
}

void warn(const DipFigures& figures, const film::Outline& outline, Warnings& warnings) {
  const auto percent = [](double share) {
    return std::to_string(static_cast<int>(std::lround(1000 * share)) / 10.0).substr(0, 4) + " %";
  };
  const std::string depth = std::to_string(figures.depth_mm) + " mm immersion";
  if (figures.stopped_at_edge) {
    warnings.push_back({"film_edge_reached",
                        "the waterline reaches the edge of the film " + outline.name +
                            "; the dip ends there and nothing above it is printed",
                        depth});
  }
  if (figures.clamped_share > 0) {
    warnings.push_back({"theta_clamped",
                        "faces within 10 degrees of level, facing up, make " +
                            percent(figures.clamped_share) +
                            " of the surface; there theta is clamped at 170 degrees and the map "
                            "is not to be trusted",
                        "surface"});
  }
  if (figures.coverage < 0.995) {
    warnings.push_back({"parts_not_reached",
                        "film reaches " + percent(figures.coverage) +
                            " of the surface; the rest stays bare. Turn the object or dip it again",
                        "surface"});
  }
  if (figures.stretch_max > 1.3) {
    warnings.push_back({"stretch_beyond_stokes",
                        "the film is stretched up to " + std::to_string(figures.stretch_max) +
                            " times; beyond 1.3 Stokes flow alone is not accurate (section 4.4)",
                        "surface"});
  }
}

}  // namespace

Result<Dip> dip(const mesh::Model& model, const DipOptions& options, const Context& context) {
  Dip result;
  HP_ASSIGN_OR_RETURN(result.surface, mesh::make_surface(model, kSurfaceEdge_mm, context));
  result.X_FO = options.X_FO.value_or(waterline::centred_pose(result.surface));
  const waterline::Body body = waterline::place(result.surface, result.X_FO);
  const film::Outline outline = floating(options.outline, options.profile.swelling);

  HP_ASSIGN_OR_RETURN(
      waterline::Waterlines waterlines,
      waterline::take_waterlines(body, outline, options.depth_mm.value_or(body.height_mm),
                                 options.motion, options.schedule, context));
  flow::DipField field{outline, waterlines.depth_mm, {}, {}};
  for (const waterline::Waterline& line : waterlines.lines) {
    field.immersion_mm.push_back(line.immersion_mm);
  }
  HP_ASSIGN_OR_RETURN(field.fields, solve(outline, waterlines, options.mesh, context));
  if (options.film_model == FilmModel::kSheet) {
    HP_ASSIGN_OR_RETURN(
        sheet::SheetFlow sheet,
        sheet::sheet_flow(std::move(field), options.rest_thickness ? options.rest_thickness : [](const auto&) { return 1.0; }, options.sheet, context));
    field = std::move(sheet.field);
    result.figures.sweeps = sheet.sweeps;
  }

  flow::MapOptions map_options = options.map;
  map_options.dip_speed_mm_per_s = options.dip_speed_mm_per_s;
  map_options.swelling = options.profile.swelling;
  HP_ASSIGN_OR_RETURN(result.map, flow::make_flow_map(result.surface, body, field, options.motion,
                                                      map_options, context));

  result.figures.depth_mm = waterlines.depth_mm;
  result.figures.stopped_at_edge = waterlines.stopped_at_edge;
  result.figures.steps = static_cast<int>(field.fields.size());
  for (const velocity::VelocityField& f : field.fields) {
    const velocity::FilmMesh& mesh = f.mesh();
    result.figures.film_vertices_max =
        std::max(result.figures.film_vertices_max, static_cast<int>(mesh.vertices_mm.size()));
    result.figures.film_triangles_max =
        std::max(result.figures.film_triangles_max, static_cast<int>(mesh.triangles.size()));
  }
  measure(result.surface, body, result.map.surface, result.figures);
  result.warnings = model.warnings;
  result.warnings.insert(result.warnings.end(), result.surface.warnings.begin(),
                         result.surface.warnings.end());
  warn(result.figures, options.outline, result.warnings);
  return result;
}

}  // namespace hydroprint::pipeline
