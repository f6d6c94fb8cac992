#include "sim/worker/fit.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "sim/film/profile.h"
#include "sim/fit/residual_picture.h"
#include "sim/image/artifact_file.h"
#include "sim/image/image_file.h"
#include "sim/mesh/read_model.h"

namespace hydroprint::worker {
namespace {

/// The shortest text that reads back as the same number; empty if there is none.
std::string cell(double value) {
  if (!std::isfinite(value)) return {};
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

std::string residuals_csv(const std::vector<fit::PointResult>& points) {
  std::string out =
      "film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm,before_x_mm,before_y_mm,before_residual_mm,after_x_mm,"
      "after_y_mm,after_residual_mm,used,outlier,left_out\n";
  for (const fit::PointResult& p : points) {
    const auto& film = p.point.film_mm;
    const auto& surface = p.point.surface_mm;
    for (const double value : {film.x(), film.y(), surface.x(), surface.y(), surface.z(),
                               p.before_mm.x(), p.before_mm.y(), (p.before_mm - film).norm(),
                               p.after_mm.x(), p.after_mm.y(), (p.after_mm - film).norm()}) {
      out += cell(value) + ",";
    }
    out += std::string(p.is_used() ? "1," : "0,") + (p.is_outlier ? "1," : "0,");
    out += p.is_used() ? "\n" : "\"" + p.left_out + "\"\n";
  }
  return out;
}

}  // namespace

std::vector<Stage> fit_stages() {
  return {{"inputs", 1}, {"reading", 2}, {"fit", 96}, {"writing", 1}};
}

Status run_fit(const Options& options, const pipeline::DipOptions& dip, OutFolder& folder,
               Report& report, const Context& context) {
  HP_ASSIGN_OR_RETURN(const std::vector<fit::Point> points, fit::read_points(options.points));
  context.progress("reading", 0);
  HP_ASSIGN_OR_RETURN(const mesh::Model model,
                      mesh::read_model(options.mesh, options.scale, context));
  report.mesh_vertices = model.vertices.size();
  report.mesh_triangles = model.triangles.size();
  HP_ASSIGN_OR_RETURN(report.fit, fit::fit(model, dip, points, options.fit, context));
  report.X_FO = report.fit->X_FO;
  report.warnings = report.fit->warnings;
  context.progress("writing", 0);
  HP_RETURN_IF_ERROR(folder.create());
  const std::filesystem::path& to = folder.partial();
  HP_RETURN_IF_ERROR(
      image::write_artifact(to / "film_profile.toml", film::profile_toml(report.fit->profile)));
  HP_RETURN_IF_ERROR(
      image::write_artifact(to / "residuals.csv", residuals_csv(report.fit->points)));
  HP_RETURN_IF_ERROR(image::write_png(
      to / "residuals.png", fit::residual_picture(dip.outline, *report.fit), image::kScreenDpi));
  report.artifacts = {"film_profile.toml", "residuals.csv", "residuals.png"};
  return {};
}

}  // namespace hydroprint::worker
