#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/base/file_digest.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/calibrate/calibrate.h"
#include "sim/calibrate/swept_scan.h"
#include "sim/film/outline.h"
#include "sim/film/profile.h"
#include "sim/fit/fit.h"
#include "sim/pipeline/pipeline.h"
#include "sim/print/placement.h"
#include "sim/print/print_image.h"
#include "sim/validate/validate.h"
#include "sim/worker/options.h"

namespace hydroprint::worker {

/// A file that was read.
struct Input {
  std::string role;  ///< "mesh", "texture", "material_texture", "pose", ...
  std::filesystem::path path;
  FileDigest digest;
};

/// What report.json tells of a finished run (contract).
struct Report {
  Options options;
  std::vector<Input> inputs;
  film::Outline outline;
  film::Profile profile;
  Pose X_FO = Pose::Identity();               ///< as used
  std::array<int, 2> film_image_px = {0, 0};  ///< zeros: no film image
  std::size_t mesh_vertices = 0, mesh_triangles = 0;
  std::size_t surface_points = 0, surface_triangles = 0;
  bool closed = false;
  pipeline::DipFigures figures;
  std::optional<validate::Report> validation;  ///< of `validate`, which has none of the above
  std::optional<fit::Outcome> fit;             ///< of `fit`, which has no figures
  std::optional<print::Print> print;           ///< of `print-image`, which has none; without images
  std::optional<print::Placement> placement;   ///< of `template`, which has none; without pages
  std::optional<calibrate::Calibration> calibration;  ///< of `calibrate`, which has none
  double lowest_mm = 0;  ///< of `calibrate`: z of the object's lowest point, F
  std::optional<registration::CameraCalibration> camera;  ///< of `calibrate-camera`
  std::optional<calibrate::SweptScan> swept;              ///< of `fuse`
  std::vector<std::pair<std::string, double>> stage_seconds;
  double total_s = 0;
  Warnings warnings;
  std::vector<std::string> artifacts;  ///< file names, report.json not among them
};

/// report.json's content. What is not finite is told as null.
[[nodiscard]] std::string report_json(const Report& report);

/// The summary for `--json`: where the artifacts are and the figures that matter, on one line.
[[nodiscard]] std::string summary_json(const Report& report, const std::filesystem::path& dir);

/// The same for people, a line or two.
[[nodiscard]] std::string summary_text(const Report& report, const std::filesystem::path& dir);

}  // namespace hydroprint::worker
