#include "sim/worker/report.h"

#include <sys/resource.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "sim/calibrate/camera_file.h"
#include "sim/worker/calibrate_json.h"
#include "sim/worker/fit_json.h"
#include "sim/worker/fuse_json.h"
#include "sim/worker/print_json.h"
#include "sim/worker/validate_json.h"

namespace hydroprint::worker {
namespace {

using Json = nlohmann::ordered_json;

std::int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

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

Json inputs_json(const std::vector<Input>& inputs) {
  Json out = Json::array();
  for (const Input& input : inputs) {
    out.push_back({{"role", input.role},
                   {"path", input.path.string()},
                   {"sha256", input.digest.sha256},
                   {"size_bytes", input.digest.size_bytes}});
  }
  return out;
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

Json stretch_json(const pipeline::DipFigures& figures) {
  return {{"p50", figures.stretch_p50}, {"p95", figures.stretch_p95}, {"max", figures.stretch_max}};
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

Json warnings_json(const Warnings& warnings) {
  Json out = Json::array();
  for (const Warning& warning : warnings) {
    out.push_back({{"code", warning.code}, {"message", warning.message}, {"where", warning.where}});
  }
  return out;
}

Json seconds_json(const std::vector<std::pair<std::string, double>>& seconds) {
  Json out = Json::object();
  for (const auto& [stage, value] : seconds) out[stage] = value;
  return out;
}

std::string dump(const Json& json, int indent) {
  // File names need not be UTF-8; JSON has to be.
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

const char* verb_name(Verb verb) {
  switch (verb) {
    case Verb::kSimulate:
      return "simulate";
    case Verb::kPredict:
      return "predict";
    case Verb::kFit:
      return "fit";
    case Verb::kValidate:
      return "validate";
    case Verb::kPrintImage:
      return "print-image";
    case Verb::kTemplate:
      return "template";
    case Verb::kCalibrate:
      return "calibrate";
    case Verb::kCalibrateCamera:
      return "calibrate-camera";
    case Verb::kFuse:
      return "fuse";
  }
  return "";
}

Json calibration_report(const Report& report) {
  Json out = {{"program", "hydroprint-worker"},
              {"version", HYDROPRINT_VERSION},
              {"verb", verb_name(report.options.verb)},
              {"inputs", inputs_json(report.inputs)}};
  if (report.calibration) {
    const Options& o = report.options;
    out["parameters"] = {
        {"scale", o.scale}, {"film", film_json(report.outline)}, {"threads", o.threads}};
    out["parameters"]["gripper_mm"] = o.gripper_mm ? Json(*o.gripper_mm) : Json();
    out["mesh"] = {{"vertices", report.mesh_vertices}, {"triangles", report.mesh_triangles}};
    out["calibration"] = calibration_json(*report.calibration, report.lowest_mm);
  } else if (report.swept) {
    out["parameters"] = {{"voxel_mm", report.options.voxel_mm},
                         {"threads", report.options.threads}};
    out["scan"] = swept_json(*report.swept);
  } else {
    out["camera"] = Json::parse(calibrate::camera_summary_json(*report.camera));
  }
  out.update({{"stage_seconds", seconds_json(report.stage_seconds)},
              {"total_seconds", report.total_s},
              {"peak_memory_bytes", peak_memory_bytes()},
              {"warnings", warnings_json(report.warnings)},
              {"artifacts", report.artifacts}});
  return out;
}

Json calibration_summary(const Report& report, const std::filesystem::path& dir) {
  Json out = {{"out", dir.string()}, {"artifacts", report.artifacts}};
  if (report.calibration) {
    out.update(calibration_json(*report.calibration, report.lowest_mm));
  } else if (report.swept) {
    out.update(swept_json(*report.swept));
  } else {
    out.update({{"views", report.camera->views}, {"rms_mm", report.camera->rms_mm}});
  }
  out.update({{"seconds", report.total_s}, {"warnings", warnings_json(report.warnings)}});
  return out;
}

}  // namespace

std::string report_json(const Report& report) {
  if (report.validation) {
    return dump({{"program", "hydroprint-worker"},
                 {"version", HYDROPRINT_VERSION},
                 {"verb", verb_name(report.options.verb)},
                 {"parameters", validation_parameters_json(report.options)},
                 {"passed", report.validation->passed},
                 {"failed", report.validation->failed},
                 {"experiments", experiments_json(*report.validation)},
                 {"stage_seconds", seconds_json(report.stage_seconds)},
                 {"total_seconds", report.total_s},
                 {"peak_memory_bytes", peak_memory_bytes()},
                 {"artifacts", report.artifacts}},
                2);
  }
  if (report.fit) {
    return dump(
        {{"program", "hydroprint-worker"},
         {"version", HYDROPRINT_VERSION},
         {"verb", verb_name(report.options.verb)},
         {"inputs", inputs_json(report.inputs)},
         {"parameters", dip_parameters_json(report)},
         {"mesh", {{"vertices", report.mesh_vertices}, {"triangles", report.mesh_triangles}}},
         {"fit", fit_json(*report.fit, report.options.fit)},
         {"profile", profile_json(report.fit->profile)},
         {"stage_seconds", seconds_json(report.stage_seconds)},
         {"total_seconds", report.total_s},
         {"peak_memory_bytes", peak_memory_bytes()},
         {"warnings", warnings_json(report.warnings)},
         {"artifacts", report.artifacts}},
        2);
  }
  if (report.print) {
    return dump({{"program", "hydroprint-worker"},
                 {"version", HYDROPRINT_VERSION},
                 {"verb", verb_name(report.options.verb)},
                 {"inputs", inputs_json(report.inputs)},
                 {"parameters", print_parameters_json(report.options, film_json(report.outline))},
                 {"print", print_json(*report.print)},
                 {"stage_seconds", seconds_json(report.stage_seconds)},
                 {"total_seconds", report.total_s},
                 {"peak_memory_bytes", peak_memory_bytes()},
                 {"warnings", warnings_json(report.warnings)},
                 {"artifacts", report.artifacts}},
                2);
  }
  if (report.placement) {
    Json parameters = page_parameters_json(report.options, film_json(report.outline));
    parameters.update({{"scale", report.options.scale}, {"pose", pose_json(report.X_FO)}});
    return dump(
        {{"program", "hydroprint-worker"},
         {"version", HYDROPRINT_VERSION},
         {"verb", verb_name(report.options.verb)},
         {"inputs", inputs_json(report.inputs)},
         {"parameters", parameters},
         {"mesh", {{"vertices", report.mesh_vertices}, {"triangles", report.mesh_triangles}}},
         {"placement", placement_json(*report.placement)},
         {"stage_seconds", seconds_json(report.stage_seconds)},
         {"total_seconds", report.total_s},
         {"peak_memory_bytes", peak_memory_bytes()},
         {"warnings", warnings_json(report.warnings)},
         {"artifacts", report.artifacts}},
        2);
  }
  if (report.calibration || report.camera || report.swept)
    return dump(calibration_report(report), 2);
  const pipeline::DipFigures& f = report.figures;
  return dump({{"program", "hydroprint-worker"},
               {"version", HYDROPRINT_VERSION},
               {"verb", verb_name(report.options.verb)},
               {"inputs", inputs_json(report.inputs)},
               {"parameters", parameters_json(report)},
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
               {"ink_passes", ink_passes_json(f.ink_passes)},
               {"stage_seconds", seconds_json(report.stage_seconds)},
               {"total_seconds", report.total_s},
               {"peak_memory_bytes", peak_memory_bytes()},
               {"warnings", warnings_json(report.warnings)},
               {"artifacts", report.artifacts}},
              2);
}

std::string summary_json(const Report& report, const std::filesystem::path& dir) {
  if (report.validation) {
    return dump({{"out", dir.string()},
                 {"artifacts", report.artifacts},
                 {"passed", report.validation->passed},
                 {"failed", report.validation->failed},
                 {"seconds", report.total_s}},
                -1);
  }
  if (report.fit) {
    Json out = {{"out", dir.string()}, {"artifacts", report.artifacts}};
    out.update(fit_summary_json(*report.fit));
    out.update({{"seconds", report.total_s}, {"warnings", warnings_json(report.warnings)}});
    return dump(out, -1);
  }
  if (report.print) {
    return dump({{"out", dir.string()},
                 {"artifacts", report.artifacts},
                 {"sheets", report.print->layout.sheets.size()},
                 {"dpi", report.print->dpi},
                 {"seconds", report.total_s},
                 {"warnings", warnings_json(report.warnings)}},
                -1);
  }
  if (report.placement) {
    Json out = {{"out", dir.string()}, {"artifacts", report.artifacts}};
    out.update(placement_json(*report.placement));
    out.update({{"seconds", report.total_s}, {"warnings", warnings_json(report.warnings)}});
    return dump(out, -1);
  }
  if (report.calibration || report.camera || report.swept)
    return dump(calibration_summary(report, dir), -1);
  return dump({{"out", dir.string()},
               {"artifacts", report.artifacts},
               {"coverage", report.figures.coverage},
               {"depth_mm", report.figures.depth_mm},
               {"stretch", stretch_json(report.figures)},
               {"seconds", report.total_s},
               {"warnings", warnings_json(report.warnings)}},
              -1);
}

std::string summary_text(const Report& report, const std::filesystem::path& dir) {
  if (report.validation) return validation_text(*report.validation, dir);
  if (report.fit) return fit_text(*report.fit, dir);
  if (report.print) return print_text(*report.print, report.artifacts, dir);
  if (report.placement) return placement_text(*report.placement, dir);
  if (report.calibration) return calibration_text(*report.calibration, dir);
  if (report.swept) return swept_text(*report.swept, dir);
  if (report.camera) return camera_text(*report.camera, dir);
  std::string files;
  for (const std::string& name : report.artifacts) files += name + " ";
  std::array<char, 200> figures;
  std::snprintf(figures.data(), figures.size(),
                "film reaches %.1f %% of the surface, stretched at most %.2f times; %.1f s\n",
                100 * report.figures.coverage, report.figures.stretch_max, report.total_s);
  return dir.string() + ": " + files + "report.json\n" + figures.data();
}

}  // namespace hydroprint::worker
