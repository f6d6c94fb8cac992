#include "sim/worker/common/film_flow.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "hydroprint/v1/report.pb.h"
#include "sim/base/number_text.h"
#include "sim/image/film/film_image.h"
#include "sim/worker/common/fields.h"

namespace hydroprint::worker {
namespace {

const char* rule_name(mesh::SideRule rule) {
  switch (rule) {
    case mesh::SideRule::kVolume:
      return "volume";
    case mesh::SideRule::kCavity:
      return "cavity";
    case mesh::SideRule::kRays:
      return "rays";
    case mesh::SideRule::kUndecided:
      break;
  }
  return "undecided";
}

void add_shells(const std::vector<mesh::Shell>& shells, v1::MeshFacts& out) {
  for (const mesh::Shell& shell : shells) {
    v1::MeshFacts::Shell& added = *out.add_shells();
    added.set_triangles(static_cast<std::int32_t>(shell.triangles));
    added.set_area_mm2(shell.area_mm2);
    added.set_closed(shell.closed);
    added.set_rule(rule_name(shell.rule));
    added.set_turned_over(shell.turned_over);
  }
}

void add_sections(const std::vector<waterline::SectionArea>& sections, v1::FlowFacts& out) {
  for (const waterline::SectionArea& section : sections) {
    v1::FlowFacts::Section& added = *out.add_sections();
    added.set_depth_mm(section.depth_mm);
    added.set_area_mm2(section.area_mm2);
  }
}

void add_ink_passes(const std::vector<pipeline::InkPass>& passes, v1::FlowFacts& out) {
  for (const pipeline::InkPass& pass : passes) {
    v1::FlowFacts::InkPass& added = *out.add_ink_passes();
    added.set_moved_rms_mm(pass.moved_rms_mm);
    added.set_moved_p999_mm(pass.moved_most_mm);
    added.set_moved_max_mm(pass.moved_max_mm);
  }
}

/// Returns the quantiles of the stretch; nullopt if film reaches no surface.
std::optional<pipeline::StretchQuantiles> stretch_of(const pipeline::DipFigures& figures) {
  if (figures.stretch_max <= 0) return std::nullopt;
  return pipeline::StretchQuantiles{figures.stretch_p50, figures.stretch_p95, figures.stretch_max};
}

void append(std::vector<Stage>& stages, const std::vector<Stage>& more) {
  stages.insert(stages.end(), more.begin(), more.end());
}

/// Returns the stages of the Stokes pass, which a tolerance may repeat.
std::vector<Stage> first_pass(const FlowOptions& options) {
  std::vector<Stage> out;
  const int passes = options.tolerance_mm ? 1 + pipeline::DipOptions::kMostRefinements : 1;
  for (int pass = 0; pass < passes; ++pass) append(out, {{"waterline", 1}, {"velocity", 9}});
  return out;
}

/// @param is_planned  one dip of a plan
std::vector<Stage> stages(const FlowOptions& options, bool is_simulation, bool is_planned) {
  const int passes = options.is_sheet() ? options.passes() : 0;
  const Stage ink{"ink", 0.5};
  const Stage sheet{"sheet", options.inertia ? 90.0 : 30.0};

  std::vector<Stage> out = {{"inputs", 0.5}};
  if (!options.ink_image.empty()) out.push_back(ink);
  out.push_back({"reading", 4});
  if (!is_simulation && passes > 0) out.push_back(ink);
  out.push_back({"surface", 1});
  if (is_planned) append(out, {{"regions", 0.5}, {"blend", 1}});
  append(out, first_pass(options));
  if (is_planned) append(out, {{"flow map", 10}, {"regions", 0.5}});
  if (is_simulation && passes > 0) {
    for (int pass = 0; pass < passes; ++pass) {
      append(out, {{"flow map", 10}, {"film image", 1}, ink, sheet});
    }
  } else if (options.is_sheet()) {
    out.push_back(sheet);
  }
  out.push_back({"flow map", 15});
  if (!options.map_only) {
    if (is_simulation) out.push_back({"film image", 7});
    out.push_back({"pictures", 20});
  }
  out.push_back({"writing", 4});
  return out;
}

void set_film_used(const flow::SurfaceMap& map, v1::FlowFacts& out) {
  Eigen::AlignedBox2d used;
  for (const Eigen::Vector2d& point_mm : map.film_mm)
    if (point_mm.allFinite()) used.extend(point_mm);
  if (used.isEmpty()) return;
  for (const int axis : {0, 1}) {
    out.add_film_used_min_mm(used.min()[axis]);
    out.add_film_used_max_mm(used.max()[axis]);
  }
}

}  // namespace

Status choose(FlowOptions& options, v1::Model model, bool inertia, v1::ArtifactSet artifacts) {
  if (inertia && model == v1::MODEL_STOKES) {
    return fail_field(Code::kInvalidArgument, "inertia",
                      "not available with Stokes flow. Use model sheet, or leave inertia out");
  }
  if (model == v1::MODEL_STOKES) options.film_model = pipeline::FilmModel::kStokes;
  options.inertia = inertia;
  options.map_only = artifacts == v1::ARTIFACT_SET_MAP;
  return {};
}

Status check_film_image(const film::Outline& outline, double dpi) {
  const image::FilmGrid grid = image::film_grid(outline, 25.4 / dpi);
  const double pixels = static_cast<double>(grid.columns) * grid.rows;
  if (pixels <= image::kMaxFilmImage_px) return {};
  const int most_dpi = static_cast<int>(dpi * std::sqrt(image::kMaxFilmImage_px / pixels));
  return fail_field(
      Code::kOutOfRange, "dpi",
      fmt::format(
          "the film image would have too many pixels ({} x {}). Use at most {} dpi for this film",
          grid.columns, grid.rows, most_dpi));
}

Status add_material_textures(const mesh::Model& model, v1::RunFacts& run) {
  for (const mesh::Material& material : model.materials) {
    if (!material.texture_bytes.empty()) continue;
    HP_RETURN_IF_ERROR(add_inputs(run, {{"material_texture", material.texture}}));
  }
  return {};
}

std::vector<Stage> simulate_stages(const FlowOptions& options, bool is_planned) {
  return stages(options, true, is_planned);
}

std::vector<Stage> predict_stages(const FlowOptions& options) {
  return stages(options, false, false);
}

std::vector<Stage> plan_stages(const FlowOptions& options, std::size_t dips) {
  std::vector<Stage> flow = first_pass(options);
  flow.push_back({"flow map", 10});
  std::vector<Stage> out = {{"inputs", 0.5}, {"reading", 4}, {"surface", 1}};
  for (std::size_t k = 0; k < dips; ++k) append(out, flow);
  append(out, {{"regions", 0.5}, {"blend", 1}, {"blend weights", 1}});
  for (std::size_t k = 0; k < dips; ++k) {
    append(out, first_pass(options));
    const int passes = options.is_sheet() ? options.passes() : 0;
    for (int pass = 0; pass < passes; ++pass) {
      append(out, {{"flow map", 10}, {"film image", 2}, {"ink", 0.5}, {"sheet", 30}});
    }
    if (options.is_sheet() && passes == 0) out.push_back({"sheet", 30});
    append(out, {{"flow map", 15}, {"film image", 14}, {"pictures", 10}, {"writing", 6}});
  }
  append(out, {{"pictures", 10}, {"writing", 2}});
  return out;
}

Result<pipeline::DipOptions> read_flow(const FlowOptions& options, v1::RunFacts& run,
                                       const Context& context) {
  HP_ASSIGN_OR_RETURN(pipeline::DipOptions dip,
                      read_inked_dip(options.dip, options.ink_image, run, context));
  dip.film_model = options.film_model;
  dip.inertia = options.inertia;
  dip.tolerance_mm = options.tolerance_mm;
  return dip;
}

void set_parameters(const FlowOptions& options, const pipeline::DipOptions& dip, const Pose& X_FO,
                    v1::FlowParameters& out) {
  set_dip(options.dip, dip, X_FO, *out.mutable_dip());
  out.set_dpi(options.dpi);
  out.set_model(options.is_sheet() ? v1::MODEL_SHEET : v1::MODEL_STOKES);
  out.set_inertia(options.inertia);
  if (options.tolerance_mm) out.set_tolerance_mm(*options.tolerance_mm);
  out.set_ink_passes(options.is_sheet() ? options.passes() : 0);
  out.set_artifacts(options.map_only ? v1::ARTIFACT_SET_MAP : v1::ARTIFACT_SET_ALL);
}

void set_stretch(const std::optional<pipeline::StretchQuantiles>& stretch, v1::StretchFacts& out) {
  if (!stretch) return;
  out.set_p50(stretch->p50);
  out.set_p95(stretch->p95);
  out.set_max(stretch->max);
}

void set_error(const pipeline::MapError& error, v1::MapError& out) {
  out.set_p50_mm(error.p50_mm);
  out.set_p95_mm(error.p95_mm);
  out.set_above_pixel_share(error.above_pixel_share);
  out.set_no_bound_share(error.no_bound_share);
}

void set_flow(const pipeline::Dip& dip, v1::MeshFacts& mesh, v1::FlowFacts& out) {
  const pipeline::DipFigures& figures = dip.figures;
  set_surface(dip.surface, mesh);
  add_shells(dip.surface.shells, mesh);
  mesh.set_film_vertices_max(figures.film_vertices_max);
  mesh.set_film_triangles_max(figures.film_triangles_max);
  out.set_steps(figures.steps);
  add_sections(figures.sections, out);
  out.set_waterlines_passed_over(static_cast<std::int32_t>(figures.passed_over_mm.size()));
  out.set_depth_mm(figures.depth_mm);
  out.set_stopped_at_film_edge(figures.stopped_at_edge);
  out.set_coverage(figures.coverage);
  out.set_theta_clamped_share(figures.clamped_share);
  out.set_wrinkled_share(figures.wrinkled_share);
  out.set_torn_share(figures.torn_share);
  set_stretch(stretch_of(figures), *out.mutable_stretch());
  if (figures.error) set_error(*figures.error, *out.mutable_error());
  out.set_sheet_unsettled_mm(figures.unsettled_mm);
  add_ink_passes(figures.ink_passes, out);
  set_film_used(dip.map.surface, out);
}

std::string flow_summary(const std::filesystem::path& dir, const v1::RunFacts& run,
                         const v1::FlowFacts& flow) {
  return fmt::format("{}film reaches {} of the surface; maximum stretch {}; {:.1f} s\n",
                     artifacts_line(dir, run), percent(flow.coverage()),
                     three_digits(flow.stretch().max()), run.total_seconds());
}

}  // namespace hydroprint::worker
