#include "sim/worker/run.h"

#include <chrono>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/base/pose_file.h"
#include "sim/image/artifact_file.h"
#include "sim/image/film_image.h"
#include "sim/ink/ink_of.h"
#include "sim/pipeline/predict.h"
#include "sim/pipeline/simulate.h"
#include "sim/worker/artifacts.h"
#include "sim/worker/calibrate.h"
#include "sim/worker/fit.h"
#include "sim/worker/fuse.h"
#include "sim/worker/motion_file.h"
#include "sim/worker/out_folder.h"
#include "sim/worker/print_image.h"
#include "sim/worker/progress.h"
#include "sim/worker/progress_sinks.h"
#include "sim/worker/report.h"
#include "sim/worker/stages.h"
#include "sim/worker/template.h"
#include "sim/worker/validate.h"

namespace hydroprint::worker {
namespace {

namespace fs = std::filesystem;

double seconds_now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

/// The named files' fingerprints; whatever is missing is refused before anything is computed.
Result<std::vector<Input>> fingerprint(const std::vector<std::pair<std::string, fs::path>>& files) {
  std::vector<Input> out;
  for (const auto& [role, path] : files) {
    if (path.empty()) continue;
    HP_ASSIGN_OR_RETURN(FileDigest digest, digest_file(path));
    out.push_back({role, path, std::move(digest)});
  }
  return out;
}

/// Refuses before the dip a film image that would be refused after it.
Status check_film_image(const film::Outline& outline, double dpi) {
  const image::FilmGrid grid = image::film_grid(outline, 25.4 / dpi);
  const double pixels = static_cast<double>(grid.columns) * grid.rows;
  if (pixels <= image::kMaxFilmImage_px) return {};
  const int most_dpi = static_cast<int>(dpi * std::sqrt(image::kMaxFilmImage_px / pixels));
  return fail(Code::kOutOfRange, "--dpi: the film image would have " +
                                     std::to_string(grid.columns) + " x " +
                                     std::to_string(grid.rows) + " pixels. Use at most " +
                                     std::to_string(most_dpi) + " for this film");
}

Result<Report> read_parameters(const Options& o, pipeline::DipOptions& dip,
                               const Context& context) {
  Report report;
  report.options = o;
  HP_ASSIGN_OR_RETURN(report.inputs, fingerprint({{"mesh", o.mesh},
                                                  {"texture", o.texture},
                                                  {"film_image", o.film_image},
                                                  {"pose", o.pose},
                                                  {"profile", o.profile},
                                                  {"ink_image", o.ink_image},
                                                  {"film", film::polygon_file(o.film).value_or("")},
                                                  {"motion", o.motion},
                                                  {"points", o.points},
                                                  {"layout", o.layout},
                                                  {"camera", o.camera},
                                                  {"icc_profile", o.print.colours.icc_profile}}));
  for (const fs::path& view : o.frames) {
    HP_ASSIGN_OR_RETURN(auto frames, fingerprint({{"frames", view / "frames.json"}}));
    report.inputs.insert(report.inputs.end(), frames.begin(), frames.end());
  }
  HP_ASSIGN_OR_RETURN(dip.outline, film::parse_outline(o.film));
  if (o.verb == Verb::kSimulate && !o.map_only) {
    HP_RETURN_IF_ERROR(check_film_image(dip.outline, o.dpi));
  }
  if (!o.pose.empty()) {
    HP_ASSIGN_OR_RETURN(const PoseFile file, read_pose_file(o.pose));
    dip.X_FO = file.pose();
  }
  if (!o.profile.empty()) {
    HP_ASSIGN_OR_RETURN(dip.profile, film::read_profile(o.profile));
    HP_ASSIGN_OR_RETURN(auto icc, fingerprint({{"ink_icc_profile", dip.profile.ink_icc_profile}}));
    report.inputs.insert(report.inputs.end(), icc.begin(), icc.end());
  }
  dip.film_model = o.film_model;
  dip.inertia = o.inertia;
  if (!o.ink_image.empty()) {
    HP_ASSIGN_OR_RETURN(dip.ink, ink::read_ink_image(o.ink_image, dip.outline,
                                                     {dip.profile.ink_icc_profile}, context));
  }
  if (!o.motion.empty()) {
    HP_ASSIGN_OR_RETURN(dip.motion, read_motion(o.motion));
  }
  dip.depth_mm = o.depth_mm;
  dip.dip_speed_mm_per_s = o.dip_speed_mm_per_s;
  report.outline = dip.outline;
  report.profile = dip.profile;
  return report;
}

/// Fills in what the computation found out.
Status complete(Report& report, const mesh::Model& model, const pipeline::Dip& dip,
                const Warnings& warnings, bool own_textures) {
  report.X_FO = dip.X_FO;
  report.mesh_vertices = model.vertices.size();
  report.mesh_triangles = model.triangles.size();
  report.surface_points = dip.surface.points.size();
  report.surface_triangles = dip.surface.triangles.size();
  report.closed = dip.surface.closed;
  report.figures = dip.figures;
  report.warnings = warnings;
  if (!own_textures) return {};
  for (const mesh::Material& material : model.materials) {
    if (!material.texture_bytes.empty()) continue;  // a part of the model's own file
    HP_ASSIGN_OR_RETURN(auto inputs, fingerprint({{"material_texture", material.texture}}));
    report.inputs.insert(report.inputs.end(), inputs.begin(), inputs.end());
  }
  return {};
}

Status run_simulate(const Options& o, pipeline::DipOptions dip, OutFolder& folder, Report& report,
                    const Context& context) {
  pipeline::SimulateOptions options;
  options.mesh = o.mesh;
  options.scale = o.scale;
  if (!o.texture.empty()) options.texture = o.texture;
  options.dip = std::move(dip);
  options.dpi = o.dpi;
  options.ink_passes = o.ink_image.empty() ? o.ink_passes : 0;
  options.images = !o.map_only;
  HP_ASSIGN_OR_RETURN(const pipeline::Simulation simulation, pipeline::simulate(options, context));
  HP_RETURN_IF_ERROR(complete(report, simulation.model, simulation.dip, simulation.warnings,
                              options.images && o.texture.empty()));
  if (simulation.images) {
    report.film_image_px = {simulation.images->film.width, simulation.images->film.height};
  }
  HP_RETURN_IF_ERROR(folder.create());
  HP_ASSIGN_OR_RETURN(report.artifacts,
                      write_artifacts(folder.partial(), simulation, o.dpi, context));
  return {};
}

Status run_predict(const Options& o, pipeline::DipOptions dip, OutFolder& folder, Report& report,
                   const Context& context) {
  pipeline::PredictOptions options;
  options.mesh = o.mesh;
  options.scale = o.scale;
  options.film_image = o.film_image;
  options.dip = std::move(dip);
  options.ink_passes = o.ink_image.empty() ? o.ink_passes : 0;
  options.images = !o.map_only;
  HP_ASSIGN_OR_RETURN(const pipeline::Prediction prediction, pipeline::predict(options, context));
  HP_RETURN_IF_ERROR(
      complete(report, prediction.model, prediction.dip, prediction.warnings, false));
  HP_RETURN_IF_ERROR(folder.create());
  HP_ASSIGN_OR_RETURN(report.artifacts, write_artifacts(folder.partial(), prediction, context));
  return {};
}

/// Does what the verb says.
Status run_verb(const Options& o, pipeline::DipOptions dip, OutFolder& folder, Report& report,
                const Context& context) {
  switch (o.verb) {
    case Verb::kSimulate:
      return run_simulate(o, std::move(dip), folder, report, context);
    case Verb::kPredict:
      return run_predict(o, std::move(dip), folder, report, context);
    case Verb::kFit:
      return run_fit(o, dip, folder, report, context);
    case Verb::kValidate:
      return run_validate(o, folder, report, context);
    case Verb::kPrintImage:
      return run_print_image(o, folder, report, context);
    case Verb::kTemplate:
      return run_template(o, dip, folder, report, context);
    case Verb::kCalibrate:
      return run_calibrate(o, dip, folder, report, context);
    case Verb::kCalibrateCamera:
      return run_calibrate_camera(o, folder, report, context);
    case Verb::kFuse:
      return run_fuse(o, folder, report, context);
    case Verb::kPreview:
      break;  // answers, and leaves no folder: run_preview
  }
  return fail(Code::kInternal, "no such verb");
}

/// Where progress goes: a pipe, a terminal, both or nowhere.
class ProgressSink {
 public:
  ProgressSink(int pipe, int stderr_fd) : pipe_(pipe), line_(stderr_fd) {}
  void operator()(const ProgressReport& report) {
    pipe_.write(report);
    line_.show(report);
  }

 private:
  ProgressPipe pipe_;
  ProgressLine line_;
};

Status compute(const Options& o, OutFolder& folder, Report& report, Progress& progress,
               const Context& context) {
  context.progress("inputs", 0);
  pipeline::DipOptions dip;
  HP_ASSIGN_OR_RETURN(report, read_parameters(o, dip, context));
  HP_RETURN_IF_ERROR(check_cancelled(context));
  HP_RETURN_IF_ERROR(run_verb(o, std::move(dip), folder, report, context));
  report.stage_seconds = progress.stage_seconds();
  report.total_s = progress.total_s();
  const std::string text = report_json(report);
  HP_RETURN_IF_ERROR(image::write_artifact(
      folder.partial() / "report.json",
      std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size())));
  context.progress("writing", 1);
  return check_cancelled(context);
}

}  // namespace

Result<Finished> run(const Options& options, Ending& ending, int stderr_fd) {
  HP_ASSIGN_OR_RETURN(OutFolder folder, OutFolder::plan(options.out));
  const CleanupAtEnding cleanup(ending, [&folder] { folder.abandon(); });
  Finished finished;
  {
    ProgressSink sink(options.progress_fd, stderr_fd);
    Progress progress(stages(options), seconds_now, std::ref(sink));
    const Context context{
        options.threads,
        [&progress](std::string_view stage, double fraction) { progress.update(stage, fraction); },
        [&ending] { return ending.requested(); }};
    Status status = compute(options, folder, finished.report, progress, context);
    if (!status) {
      status.error().message = folder.in_terms_of_dir(std::move(status.error().message));
      return tl::unexpected(std::move(status).error());
    }
  }
  ending.decide();
  HP_RETURN_IF_ERROR(folder.commit());
  finished.dir = folder.dir();
  return finished;
}

}  // namespace hydroprint::worker
