#include "sim/worker/report.h"

#include <sys/resource.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "sim/calibrate/camera_file.h"
#include "sim/worker/calibrate_json.h"
#include "sim/worker/dip_json.h"
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
    case Verb::kPreview:
      return "preview";
  }
  return "";
}

Json mesh_json(const Report& report) {
  return {{"vertices", report.mesh_vertices}, {"triangles", report.mesh_triangles}};
}

Json fitted_json(const Report& report) {
  return {{"parameters", dip_parameters_json(report)},
          {"mesh", mesh_json(report)},
          {"fit", fit_json(*report.fit, report.options.fit)},
          {"profile", profile_json(report.fit->profile)}};
}

Json placed_json(const Report& report) {
  Json parameters = page_parameters_json(report.options, film_json(report.outline));
  parameters.update({{"scale", report.options.scale}, {"pose", pose_json(report.X_FO)}});
  return {{"parameters", parameters},
          {"mesh", mesh_json(report)},
          {"placement", placement_json(*report.placement)}};
}

Json calibrated_json(const Report& report) {
  const Options& o = report.options;
  return {{"parameters",
           {{"scale", o.scale},
            {"film", film_json(report.outline)},
            {"threads", o.threads},
            {"gripper_mm", o.gripper_mm ? Json(*o.gripper_mm) : Json()}}},
          {"mesh", mesh_json(report)},
          {"calibration", calibration_json(*report.calibration, report.lowest_mm)}};
}

/// What the verb was told and found out.
Json found_json(const Report& report) {
  const Options& o = report.options;
  if (report.validation) {
    return {{"parameters", validation_parameters_json(o)},
            {"passed", report.validation->passed},
            {"failed", report.validation->failed},
            {"experiments", experiments_json(*report.validation)}};
  }
  if (report.fit) return fitted_json(report);
  if (report.print) {
    return {{"parameters", print_parameters_json(o, film_json(report.outline))},
            {"print", print_json(*report.print)}};
  }
  if (report.placement) return placed_json(report);
  if (report.calibration) return calibrated_json(report);
  if (report.swept) {
    return {{"parameters", {{"voxel_mm", o.voxel_mm}, {"threads", o.threads}}},
            {"scan", swept_json(*report.swept)}};
  }
  if (report.camera) return {{"camera", Json::parse(calibrate::camera_json(*report.camera))}};
  return dip_json(report);
}

/// What of it matters.
Json figures_json(const Report& report) {
  if (report.validation) {
    return {{"passed", report.validation->passed}, {"failed", report.validation->failed}};
  }
  if (report.fit) return fit_summary_json(*report.fit);
  if (report.print) {
    return {{"sheets", report.print->layout.sheets.size()}, {"dpi", report.print->dpi}};
  }
  if (report.placement) return placement_json(*report.placement);
  if (report.calibration) return calibration_json(*report.calibration, report.lowest_mm);
  if (report.swept) return swept_json(*report.swept);
  if (report.camera) {
    return {{"views", report.camera->views}, {"rms_mm", report.camera->rms_mm}};
  }
  return dip_summary_json(report.figures);
}

}  // namespace

std::string report_json(const Report& report) {
  Json out = {{"program", "hydroprint-worker"},
              {"version", HYDROPRINT_VERSION},
              {"verb", verb_name(report.options.verb)},
              {"inputs", inputs_json(report.inputs)}};
  out.update(found_json(report));
  out.update({{"stage_seconds", seconds_json(report.stage_seconds)},
              {"total_seconds", report.total_s},
              {"peak_memory_bytes", peak_memory_bytes()},
              {"warnings", warnings_json(report.warnings)},
              {"artifacts", report.artifacts}});
  return dump(out, 2);
}

std::string summary_json(const Report& report, const std::filesystem::path& dir) {
  Json out = {{"out", dir.string()}, {"artifacts", report.artifacts}};
  out.update(figures_json(report));
  out.update({{"seconds", report.total_s}, {"warnings", warnings_json(report.warnings)}});
  return dump(out, -1);
}

std::string summary_text(const Report& report, const std::filesystem::path& dir) {
  if (report.validation) return validation_text(*report.validation, dir);
  if (report.fit) return fit_text(*report.fit, dir);
  if (report.print) return print_text(*report.print, report.artifacts, dir);
  if (report.placement) return placement_text(*report.placement, dir);
  if (report.calibration) return calibration_text(*report.calibration, dir);
  if (report.swept) return swept_text(*report.swept, dir);
  if (report.camera) return camera_text(*report.camera, dir);
  return dip_text(report, dir);
}

}  // namespace hydroprint::worker
