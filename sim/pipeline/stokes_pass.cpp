#include "sim/pipeline/stokes_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "sim/base/number_text.h"
#include "sim/flow/flow_map.h"
#include "sim/flow/landing.h"
#include "sim/flow/map_error.h"
#include "sim/mesh/make_surface.h"
#include "sim/sheet/inertial_flow.h"
#include "sim/sheet/sheet_flow.h"
#include "sim/velocity/film_mesh.h"
#include "sim/velocity/velocity.h"
#include "sim/waterline/waterlines.h"

namespace hydroprint::pipeline {
namespace {

/// Returns the outline of the floating film, which is swollen together with its clamped edge.
film::Outline floating(film::Outline outline, const Eigen::Vector2d& swelling) {
  for (Eigen::Vector2d& p : outline.polygon) p = p.cwiseProduct(swelling);
  outline.min_mm = outline.min_mm.cwiseProduct(swelling);
  outline.max_mm = outline.max_mm.cwiseProduct(swelling);
  return outline;
}

/// Shorter dips, as shares of the body's height, may end before the first section of its tip.
constexpr double kShortDip = 0.05;

/// Waterlines whose film cannot be meshed, because two of their curves nearly touch, are skipped.
/// If their fraction exceeds this, the dip fails.
constexpr double kMostPassedOver = 0.2;

/// Factors with which the stated error covers the true one at 95 % of the points of most bodies
/// (tests/bench, bodies-error).
double error_factor(FilmModel model) { return model == FilmModel::kStokes ? 3.0 : 4.0; }

/// The velocity at one waterline.
struct Solved {
  double immersion_mm = 0;
  std::vector<char> bounds_film;                 ///< see waterline::Waterline
  std::optional<velocity::VelocityField> field;  ///< nullopt: skipped
};

/// Meshes and solves one waterline; skips it if its mesh would be unbounded.
/// @param refusal  set if the waterline is skipped
Result<Solved> solve(const film::Outline& outline, const waterline::Waterline& line,
                     const velocity::MeshOptions& options, Status& refusal) {
  Solved out{line.immersion_mm, line.bounds_film, {}};
  auto mesh = velocity::mesh_film(outline, line, options);
  if (!mesh && mesh.error().reason == ErrorReason::MESH_UNBOUNDED) {
    refusal = tl::unexpected(std::move(mesh.error()));
    return out;
  }
  if (!mesh) return tl::unexpected(std::move(mesh.error()));
  const auto fixed = velocity::boundary_velocities(*mesh, line.pulls);
  HP_ASSIGN_OR_RETURN(auto nodes, velocity::solve_stokes(*mesh, fixed));
  out.field = velocity::VelocityField(std::move(*mesh), std::move(nodes));
  return out;
}

/// Meshes and solves every waterline separately and in parallel, because Stokes flow at one
/// waterline does not depend on earlier ones.
/// @param before  waterlines that were solved before, by increasing immersion; they are used again
Result<std::vector<Solved>> solve(const film::Outline& outline, waterline::Waterlines& waterlines,
                                  const velocity::MeshOptions& options, std::vector<Solved> before,
                                  const Context& context) {
  std::vector<Solved> out(waterlines.lines.size());
  std::vector<Status> refusals(out.size());
  HP_RETURN_IF_ERROR(parallel_for(context, "velocity", out.size(), [&](std::size_t k) -> Status {
    waterline::Waterline& line = waterlines.lines[k];
    const auto known =
        std::ranges::lower_bound(before, line.immersion_mm, {}, &Solved::immersion_mm);
    if (known != before.end() && known->immersion_mm == line.immersion_mm && known->field &&
        known->bounds_film == line.bounds_film) {
      out[k] = std::move(*known);
    } else {
      HP_ASSIGN_OR_RETURN(out[k], solve(outline, line, options, refusals[k]));
    }
    line = {line.immersion_mm, {}, {}, {}};  // its curves are no longer needed
    return {};
  }));
  const auto is_refused = [](const Status& status) { return !status; };
  const auto refused = std::count_if(refusals.begin(), refusals.end(), is_refused);
  if (static_cast<double>(refused) > kMostPassedOver * static_cast<double>(out.size())) {
    return tl::unexpected(std::find_if(refusals.begin(), refusals.end(), is_refused)->error());
  }
  return out;
}

/// Returns the refusal of a closed mesh whose sections do not agree with its volume.
Error refusal_of(const waterline::SectionsOff& off, const StokesPass& pass,
                 const waterline::Motion& motion) {
  const Eigen::Vector2d at = off.place_mm - waterline::offset_at(motion, off.immersion_mm);
  const Eigen::Vector3d place =
      pass.X_FO.inverse() * Eigen::Vector3d(at.x(), at.y(), off.immersion_mm);
  std::vector<int> faces;
  for (const int t : off.triangles) {
    const int face = pass.surface.source_triangle[static_cast<std::size_t>(t)] + 1;
    if (std::ranges::find(faces, face) == faces.end() && faces.size() < 3) faces.push_back(face);
  }
  return {
      Code::kInvalidArgument,
      fmt::format("mesh: its sections enclose {} cm3, but vertical lines through it find {} cm3. "
                  "They differ most at {:.2f} mm immersion, near ({:.2f}, {:.2f}, {:.2f}) mm of "
                  "the mesh, at triangles {} of the file. Repair the mesh there in a 3D editor",
                  three_digits(off.sections_mm3 / 1000), three_digits(off.columns_mm3 / 1000),
                  off.immersion_mm, place.x(), place.y(), place.z(), fmt::join(faces, ", ")),
      ErrorReason::SECTIONS_OFF};
}

/// Compares the sections with the body's volume. Closed meshes must agree. Lines may pass through
/// the openings of open ones, which is only noted.
Status check(const waterline::Waterlines& waterlines, const waterline::Motion& motion,
             StokesPass& pass) {
  pass.sections = waterline::section_areas(waterlines.lines);
  const bool is_short = waterlines.depth_mm < kShortDip * pass.body.height_mm;
  const auto is_empty = [](const waterline::SectionArea& s) { return s.area_mm2 <= 0; };
  if (!waterlines.stopped_at_edge && !is_short && std::ranges::all_of(pass.sections, is_empty)) {
    return fail(
        Code::kInvalidArgument,
        fmt::format("no waterline of the object has a section larger than {} mm2, so it does not "
                    "move the film. Check the unit of the model, or give it a thickness of at "
                    "least 0.5 mm in a 3D editor (\"solidify\")",
                    waterline::kLeastLoop_mm2));
  }
  pass.sections_off = waterline::check_sections(pass.body, waterlines.lines, motion);
  if (!pass.sections_off || !pass.surface.closed) return {};
  return tl::unexpected(refusal_of(*pass.sections_off, pass, motion));
}

/// Takes the scheduled waterlines and solves them. Sets everything in the pass except the field.
Result<std::vector<Solved>> solve_at(const waterline::ScheduleOptions& schedule,
                                     std::vector<Solved> before, const DipOptions& options,
                                     StokesPass& out, const Context& context) {
  HP_ASSIGN_OR_RETURN(waterline::Waterlines waterlines,
                      waterline::take_waterlines(out.body, out.stokes.outline,
                                                 options.depth_mm.value_or(out.body.height_mm),
                                                 options.motion, schedule, context));
  out.stopped_at_edge = waterlines.stopped_at_edge;
  out.traps = waterlines.traps;
  out.coarse = std::move(waterlines.coarse);
  out.stokes.depth_mm = waterlines.depth_mm;
  HP_RETURN_IF_ERROR(check(waterlines, options.motion, out));
  return solve(out.stokes.outline, waterlines, options.mesh, std::move(before), context);
}

/// Sets the field of a pass to that of the waterlines that were not skipped.
void set_field(std::vector<Solved> solved, StokesPass& out) {
  out.stokes.immersion_mm.clear();
  out.stokes.fields.clear();
  out.passed_over_mm.clear();
  for (Solved& line : solved) {
    if (!line.field) {
      out.passed_over_mm.push_back(line.immersion_mm);
      continue;
    }
    out.stokes.immersion_mm.push_back(line.immersion_mm);
    out.stokes.fields.push_back(std::move(*line.field));
  }
}

/// Returns immersions at which more waterlines are needed for the tolerance; empty if none are.
Result<std::vector<double>> depths_to_add(const StokesPass& pass, const DipOptions& options,
                                          const Context& context) {
  const flow::DipField& field = pass.stokes;
  const double factor = error_factor(options.film_model), tolerance_mm = *options.tolerance_mm;
  const flow::Landings landings(pass.body, options.motion);
  const std::vector<flow::Landing>& of_points = landings.of_points();
  HP_ASSIGN_OR_RETURN(const flow::TracedBack traced,
                      flow::trace_back_with_error(
                          field, of_points, std::vector<char>(of_points.size(), 1), {}, context));
  flow::Part beyond;
  for (std::size_t v = 0; v < of_points.size(); ++v) {
    if (factor * traced.error_mm[v] > tolerance_mm) beyond.push_back(v);
  }
  if (beyond.empty()) return std::vector<double>{};
  // The error is the sum over several gaps.
  return flow::depths_to_add(field, of_points, beyond, tolerance_mm / factor / 4);
}

}  // namespace

Status check_solid(const mesh::Surface& surface, const mesh::Model& model) {
  if (!surface.is_flat) return {};
  return fail(Code::kInvalidArgument,
              model.path.string() +
                  ": the mesh is a sheet without thickness, which encloses nothing. Give it a "
                  "thickness of at least 0.5 mm in a 3D editor (\"solidify\")");
}

Result<StokesPass> run_stokes_pass(const mesh::Model& model, const DipOptions& options,
                                   const Context& context) {
  HP_ASSIGN_OR_RETURN(mesh::Surface surface,
                      mesh::make_surface(model, options.surface_edge_mm, context));
  HP_RETURN_IF_ERROR(check_solid(surface, model));
  return run_stokes_pass(std::move(surface), options, context);
}

Result<StokesPass> run_stokes_pass(mesh::Surface surface, const DipOptions& options,
                                   const Context& context) {
  StokesPass out;
  out.surface = std::move(surface);
  out.X_FO = options.X_FO.value_or(waterline::centred_pose(out.surface));
  out.body = waterline::place(out.surface, out.X_FO);
  out.stokes.outline = floating(options.outline, options.profile.swelling);
  waterline::ScheduleOptions schedule = options.schedule;
  std::vector<Solved> solved;
  for (int round = 0;; ++round) {
    HP_ASSIGN_OR_RETURN(solved, solve_at(schedule, std::move(solved), options, out, context));
    const bool is_last = !options.tolerance_mm || round == DipOptions::kMostRefinements;
    set_field(is_last ? std::move(solved) : solved, out);
    if (is_last) break;
    HP_ASSIGN_OR_RETURN(const auto added, depths_to_add(out, options, context));
    if (added.empty()) break;
    schedule.added_mm.insert(schedule.added_mm.end(), added.begin(), added.end());
  }
  return out;
}

Result<sheet::SheetFlow> sheet_field(const flow::DipField& first, const ink::InkField& ink,
                                     const DipOptions& options, const Context& context) {
  const film::Profile& profile = options.profile;
  const auto rest_thickness = [&](const std::array<Eigen::Vector2d, 3>& rest_mm) {
    // Swelling spreads film and ink by the same factor, and only relative thickness matters.
    const auto printed = [&](const Eigen::Vector2d& p) {
      return p.cwiseQuotient(profile.swelling);
    };
    return film::rest_thickness_mm(
        profile, ink.mean(printed(rest_mm[0]), printed(rest_mm[1]), printed(rest_mm[2])));
  };
  const double drag_per_mm =
      profile.drag_length_mm > 0
          ? profile.thickness_mm / (profile.drag_length_mm * profile.drag_length_mm)
          : 0;
  if (options.inertia) {
    sheet::InertialOptions inertial = {{profile.young_modulus_mpa, profile.poisson_ratio},
                                       profile.density_kg_per_m3,
                                       options.dip_speed_mm_per_s,
                                       drag_per_mm};
    inertial.tear_stretch = profile.tear_stretch;
    HP_ASSIGN_OR_RETURN(flow::DipField field,
                        sheet::inertial_flow(first, rest_thickness, inertial, context));
    return sheet::SheetFlow{std::move(field)};
  }
  sheet::SheetOptions sheet = options.sheet;
  sheet.drag_per_mm = drag_per_mm;
  sheet.tear_stretch = profile.tear_stretch;
  return sheet::sheet_flow(first, rest_thickness, sheet, context);
}

Result<flow::FlowMap> trace_flow_map(const StokesPass& pass, const flow::DipField& field,
                                     const DipOptions& options, const Context& context) {
  flow::MapOptions map = options.map;
  map.dip_speed_mm_per_s = options.dip_speed_mm_per_s;
  map.swelling = options.profile.swelling;
  map.error_factor = options.states_error ? error_factor(options.film_model) : 0;
  return flow::make_flow_map(pass.surface, pass.body, field, options.motion, map, context);
}

}  // namespace hydroprint::pipeline
