#include "tests/sim/support/dips.h"

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <utility>

#include "sim/velocity/velocity.h"
#include "sim/waterline/waterlines.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::testing {
namespace {

template <class T>
T value_of(Result<T> result) {
  if (!result) {
    std::cerr << "solve_dip: " << result.error().message << '\n';
    std::abort();
  }
  return std::move(*result);
}

}  // namespace

void DipSetting::coarsen(double factor) {
  schedule.swept_mm *= factor;
  mesh.size.at_waterline_mm *= factor;
  mesh.size.growth *= factor;
  mesh.size.most_mm *= factor;
  mesh.spacing_mm *= factor;
  mesh.tolerance_mm *= factor * factor;
}

SolvedDip solve_dip(const mesh::Model& model, const DipSetting& setting) {
  SolvedDip dip;
  dip.surface = surface_of(model, setting.max_edge_mm);
  dip.body = body_of(dip.surface);
  Context context;
  context.threads = 2;
  const auto lines = value_of(waterline::take_waterlines(
      dip.body, setting.film, std::min(setting.depth_mm, dip.body.height_mm), setting.motion,
      setting.schedule, context));
  dip.field.outline = setting.film;
  dip.field.depth_mm = lines.depth_mm;
  dip.field.fields.resize(lines.lines.size());
  for (const auto& line : lines.lines) dip.field.immersion_mm.push_back(line.immersion_mm);
  const Status status = parallel_for(context, {}, lines.lines.size(), [&](std::size_t k) -> Status {
    HP_ASSIGN_OR_RETURN(auto mesh, velocity::mesh_film(setting.film, lines.lines[k], setting.mesh));
    const auto fixed = velocity::boundary_velocities(mesh, lines.lines[k].pulls);
    HP_ASSIGN_OR_RETURN(auto nodes, velocity::solve_stokes(mesh, fixed));
    dip.field.fields[k] = velocity::VelocityField(std::move(mesh), std::move(nodes));
    return {};
  });
  value_of(Result<int>(status.map([] { return 0; })));
  return dip;
}

film::Outline round_film(double radius_mm, int corners, double turn_rad) {
  const double step = 2 * std::numbers::pi / corners;
  const double reach_mm = radius_mm * std::sqrt(step / std::sin(step));
  film::Outline film;
  film.name = "round";
  for (int i = 0; i < corners; ++i) {
    const double angle = turn_rad + i * step;
    film.polygon.emplace_back(reach_mm * std::cos(angle), reach_mm * std::sin(angle));
  }
  film.max_mm = Eigen::Vector2d::Constant(reach_mm);
  film.min_mm = -film.max_mm;
  return film;
}

film::Outline film_of(const std::string& text) { return film::parse_outline(text).value(); }

}  // namespace hydroprint::testing
