#include "sim/worker/common/film_flow.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "hydroprint/v1/spec.pb.h"
#include "sim/base/number_text.h"
#include "sim/image/film/film_image.h"
#include "sim/worker/common/fields.h"

namespace hydroprint::worker {
namespace {

/// Returns null if no error is stated.
Json error_json(const std::optional<pipeline::MapError>& error) {
  if (!error) return nullptr;
  const auto bound = [](double error_mm) {
    return std::isfinite(error_mm) ? Json(error_mm) : Json(nullptr);
  };
  return {{"p50_mm", bound(error->p50_mm)},
          {"p95_mm", bound(error->p95_mm)},
          {"above_pixel_share", error->above_pixel_share},
          {"no_bound_share", error->no_bound_share}};
}

Json sections_json(const std::vector<waterline::SectionArea>& sections) {
  Json out = Json::array();
  for (const waterline::SectionArea& section : sections) {
    out.push_back({{"depth_mm", section.depth_mm}, {"area_mm2", section.area_mm2}});
  }
  return out;
}

Json ink_passes_json(const std::vector<pipeline::InkPass>& passes) {
  Json out = Json::array();
  for (const pipeline::InkPass& pass : passes) {
    out.push_back({{"moved_rms_mm", pass.moved_rms_mm},
                   {"moved_p999_mm", pass.moved_most_mm},
                   {"moved_max_mm", pass.moved_max_mm}});
  }
  return out;
}

std::string_view rule_name(mesh::SideRule rule) {
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

Json shells_json(const std::vector<mesh::Shell>& shells) {
  Json out = Json::array();
  for (const mesh::Shell& shell : shells) {
    out.push_back({{"triangles", shell.triangles},
                   {"area_mm2", shell.area_mm2},
                   {"closed", shell.closed},
                   {"rule", rule_name(shell.rule)},
                   {"turned_over", shell.turned_over}});
  }
  return out;
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

Status add_material_textures(const mesh::Model& model, Report& report) {
  for (const mesh::Material& material : model.materials) {
    if (!material.texture_bytes.empty()) continue;
    HP_RETURN_IF_ERROR(add_inputs(report, {{"material_texture", material.texture}}));
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

Result<pipeline::DipOptions> read_flow(const FlowOptions& options, Report& report,
                                       const Context& context) {
  HP_ASSIGN_OR_RETURN(pipeline::DipOptions dip,
                      read_inked_dip(options.dip, options.ink_image, report, context));
  dip.film_model = options.film_model;
  dip.inertia = options.inertia;
  dip.tolerance_mm = options.tolerance_mm;
  return dip;
}

DipFindings::DipFindings(const pipeline::DipOptions& dip, const mesh::Model& model,
                         const pipeline::Dip& result)
    : X_FO_(result.X_FO),
      mesh_{model.vertices.size(), model.triangles.size()},
      surface_{result.surface.points.size(), result.surface.triangles.size()},
      closed_(result.surface.closed),
      shells_(result.surface.shells),
      figures_(result.figures) {
  dip_.outline = dip.outline;
  dip_.profile = dip.profile;
}

Json DipFindings::parameters(const FlowOptions& options, std::array<int, 2> film_image_px,
                             int threads) const {
  Json out = dip_parameters_json(options.dip, dip_, X_FO_, threads);
  out.update({{"dpi", options.dpi},
              {"film_image_px", film_image_px},
              {"model", options.is_sheet() ? "sheet" : "stokes"},
              {"inertia", options.inertia},
              {"tolerance_mm", options.tolerance_mm ? Json(*options.tolerance_mm) : Json(nullptr)},
              {"ink_passes", options.is_sheet() ? options.passes() : 0},
              {"artifacts", options.map_only ? "map" : "all"}});
  return out;
}

Json DipFindings::report(const FlowOptions& options, std::array<int, 2> film_image_px,
                         int threads) const {
  const pipeline::DipFigures& f = figures_;
  return {{"parameters", parameters(options, film_image_px, threads)},
          {"mesh",
           {{"vertices", mesh_.vertices},
            {"triangles", mesh_.triangles},
            {"surface_points", surface_.vertices},
            {"surface_triangles", surface_.triangles},
            {"closed", closed_},
            {"shells", shells_json(shells_)},
            {"film_vertices_max", f.film_vertices_max},
            {"film_triangles_max", f.film_triangles_max}}},
          {"steps", f.steps},
          {"sections", sections_json(f.sections)},
          {"waterlines_passed_over", f.passed_over_mm.size()},
          {"depth_mm", f.depth_mm},
          {"stopped_at_film_edge", f.stopped_at_edge},
          {"coverage", f.coverage},
          {"theta_clamped_share", f.clamped_share},
          {"wrinkled_share", f.wrinkled_share},
          {"torn_share", f.torn_share},
          {"stretch", stretch_json(f)},
          {"error", error_json(f.error)},
          {"sheet_unsettled_mm", f.unsettled_mm},
          {"ink_passes", ink_passes_json(f.ink_passes)}};
}

Json DipFindings::figures() const {
  return {{"coverage", figures_.coverage},
          {"depth_mm", figures_.depth_mm},
          {"stretch", stretch_json(figures_)}};
}

std::string DipFindings::summary(const Report& report, const std::filesystem::path& dir) const {
  return fmt::format("{}film reaches {} of the surface; maximum stretch {}; {:.1f} s\n",
                     artifacts_line(dir, report), percent(figures_.coverage),
                     three_digits(figures_.stretch_max), report.total_s);
}

}  // namespace hydroprint::worker
