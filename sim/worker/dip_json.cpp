#include "sim/worker/dip_json.h"

#include <array>
#include <cstdio>

#include "sim/worker/calibrate_json.h"
#include "sim/worker/print_json.h"

namespace hydroprint::worker {

using Json = nlohmann::ordered_json;

namespace {

Json parameters_json(const Report& report) {
  const Options& o = report.options;
  const bool is_sheet = o.film_model == pipeline::FilmModel::kSheet;
  Json out = dip_parameters_json(report);
  out.update({{"dpi", o.dpi},
              {"film_image_px", report.film_image_px},
              {"model", is_sheet ? "sheet" : "stokes"},
              {"inertia", o.inertia},
              {"ink_passes", is_sheet && o.ink_image.empty() ? o.ink_passes : 0},
              {"artifacts", o.map_only ? "map" : "all"}});
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

}  // namespace

Json film_json(const film::Outline& outline) {
  return {{"name", outline.name},
          {"min_mm", pair_of(outline.min_mm)},
          {"max_mm", pair_of(outline.max_mm)},
          {"corners", outline.polygon.size()}};
}

Json profile_json(const film::Profile& p) {
  return {{"thickness_mm", p.thickness_mm},
          {"ink_ratio_mm", p.ink_ratio_mm},
          {"ink_icc_profile", p.ink_icc_profile.string()},
          {"swelling", pair_of(p.swelling)},
          {"drag_length_mm", p.drag_length_mm},
          {"tear_stretch", p.tear_stretch},
          {"wrinkle_stretch", p.wrinkle_stretch},
          {"young_modulus_mpa", p.young_modulus_mpa},
          {"density_kg_per_m3", p.density_kg_per_m3},
          {"poisson_ratio", p.poisson_ratio},
          {"activator_ml_per_m2", p.activator_ml_per_m2},
          {"soak_s", p.soak_s},
          {"activator_wait_s", p.activator_wait_s}};
}

Json warnings_json(const Warnings& warnings) {
  Json out = Json::array();
  for (const Warning& warning : warnings) {
    out.push_back({{"code", warning.code}, {"message", warning.message}, {"where", warning.where}});
  }
  return out;
}

Json stretch_json(const pipeline::DipFigures& figures) {
  return {{"p50", figures.stretch_p50}, {"p95", figures.stretch_p95}, {"max", figures.stretch_max}};
}

Json dip_parameters_json(const Report& report) {
  const Options& o = report.options;
  Json out = {{"scale", o.scale},
              {"pose", pose_json(report.X_FO)},
              {"film", film_json(report.outline)},
              {"profile", profile_json(report.profile)},
              {"depth_mm", "full"},
              {"dip_speed_mm_per_s", o.dip_speed_mm_per_s},
              {"threads", o.threads}};
  if (o.depth_mm) out["depth_mm"] = *o.depth_mm;
  return out;
}

Json dip_json(const Report& report) {
  const pipeline::DipFigures& f = report.figures;
  return {{"parameters", parameters_json(report)},
          {"mesh",
           {{"vertices", report.mesh_vertices},
            {"triangles", report.mesh_triangles},
            {"surface_points", report.surface_points},
            {"surface_triangles", report.surface_triangles},
            {"closed", report.closed},
            {"film_vertices_max", f.film_vertices_max},
            {"film_triangles_max", f.film_triangles_max}}},
          {"steps", f.steps},
          {"waterlines_passed_over", f.passed_over_mm.size()},
          {"depth_mm", f.depth_mm},
          {"stopped_at_film_edge", f.stopped_at_edge},
          {"coverage", f.coverage},
          {"theta_clamped_share", f.clamped_share},
          {"wrinkled_share", f.wrinkled_share},
          {"torn_share", f.torn_share},
          {"stretch", stretch_json(f)},
          {"sheet_unsettled_mm", f.unsettled_mm},
          {"ink_passes", ink_passes_json(f.ink_passes)}};
}

Json dip_summary_json(const pipeline::DipFigures& figures) {
  return {{"coverage", figures.coverage},
          {"depth_mm", figures.depth_mm},
          {"stretch", stretch_json(figures)}};
}

std::string dip_text(const Report& report, const std::filesystem::path& dir) {
  std::string files;
  for (const std::string& name : report.artifacts) files += name + " ";
  std::array<char, 200> figures;
  std::snprintf(figures.data(), figures.size(),
                "film reaches %.1f %% of the surface, stretched at most %.2f times; %.1f s\n",
                100 * report.figures.coverage, report.figures.stretch_max, report.total_s);
  return dir.string() + ": " + files + "report.json\n" + figures.data();
}

}  // namespace hydroprint::worker
