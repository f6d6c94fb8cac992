#include "sim/worker/verbs/fit.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/warning_message.h"
#include "sim/base/artifact_file.h"
#include "sim/base/number_text.h"
#include "sim/film/profile.h"
#include "sim/fit/fit.h"
#include "sim/fit/residual_picture.h"
#include "sim/image/io/image_file.h"
#include "sim/mesh/read/read_model.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/dip.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples =
    R"(The file of measured points has the header film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm and then one point per line: its printed
position on the film and its measured position on the object (mesh coordinates after --scale). A parameter that the points
do not determine keeps its value from --profile; report.json gives the reason.

Examples:
  hydroprint-worker fit --mesh ball.ply --film circle:105 --points measured.csv --ink-image film.png --out fitted
  hydroprint-worker fit --mesh ball.ply --points measured.csv --profile film.toml --free drag,swelling --out fitted
  hydroprint-worker simulate --mesh spot.obj --profile fitted/film_profile.toml --out spot

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

struct FitOptions {
  DipOptions dip;
  std::filesystem::path points;
  std::filesystem::path ink_image;  ///< empty: no ink image
  fit::Options fit;
};

Result<FitOptions> read_options(const v1::FitSpec& spec, const InputFolder& inputs) {
  FitOptions out;
  HP_ASSIGN_OR_RETURN(out.dip, dip_options(spec, inputs));
  HP_ASSIGN_OR_RETURN(out.points, inputs.required("points", spec.points()));
  out.ink_image = inputs.path(spec.ink_image());
  auto free = fit::parse_parameters({spec.free().begin(), spec.free().end()});
  if (!free) return fail_field(free.error().code, "free", free.error().message);
  out.fit.free = std::move(*free);
  out.fit.drop_outliers = spec.drop_outliers();
  out.fit.points_name = out.points.string();
  return out;
}

/// Returns the shortest text that reads back as the same number; empty if the number is not finite.
std::string cell(double value) { return std::isfinite(value) ? shortest_text(value) : ""; }

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

constexpr const char* kMethod =
    "Gauss-Newton least squares of predicted minus measured printed points on the film, drag "
    "fitted as 1/drag_length_mm^2; covariance by leaving out one point at a time (linearised "
    "jackknife), plus the discretisation error, extrapolated from a run with meshes and steps of "
    "0.6 times the size; intervals by Student's t, limited to the profile's range, one-sided for "
    "an estimate at the end of that range";

void add_estimate(const fit::Estimate& estimate, v1::FitReport& out) {
  v1::FitReport::Estimate& added = *out.add_estimates();
  added.set_name(estimate.name);
  added.set_start(estimate.start);
  added.set_value(estimate.value);
  added.set_standard_error(estimate.standard_error);
  added.set_low(estimate.low);
  added.set_high(estimate.high);
  added.set_one_sided(estimate.is_one_sided);
  added.set_discretisation_share(estimate.discretisation_error / estimate.scaled_error);
  out.mutable_correlation()->add_names(estimate.name);
}

void add_undetermined(const fit::Undetermined& undetermined, v1::FitReport& out) {
  v1::FitReport::Undetermined& added = *out.add_undetermined();
  added.set_name(undetermined.name);
  added.set_reason(undetermined.reason);
}

void set_points(const std::vector<fit::PointResult>& points, v1::FitReport::Points& out) {
  std::map<std::string, int> reasons;
  int used = 0, outliers = 0;
  for (const fit::PointResult& p : points) {
    used += p.is_used() ? 1 : 0;
    outliers += p.is_outlier ? 1 : 0;
    if (!p.is_used()) ++reasons[p.left_out];
  }
  out.set_given(static_cast<std::int32_t>(points.size()));
  out.set_used(used);
  out.set_outliers(outliers);
  for (const auto& [reason, count] : reasons) {
    v1::FitReport::LeftOut& added = *out.add_left_out();
    added.set_reason(reason);
    added.set_points(count);
  }
}

/// "drag_length_mm = 60.2  (95 %: 57 to 63.5)"; an infinite drag length means no drag.
std::string estimate_text(const fit::Estimate& e) {
  const auto text = [](double value) {
    return std::isfinite(value) ? fmt::format("{:.5g}", value) : "none";
  };
  return fmt::format("{} = {}  (95 %: {}{})\n", e.name, text(e.value), text(e.low),
                     std::isfinite(e.high) ? " to " + text(e.high) : " or more, or none");
}

void set_outcome(const fit::Outcome& outcome, v1::FitReport& out) {
  out.set_confidence(fit::kConfidence);
  out.set_method(kMethod);
  for (const fit::Estimate& estimate : outcome.estimates) add_estimate(estimate, out);
  add_rows(outcome.correlation, out.mutable_correlation()->mutable_matrix());
  for (const fit::Undetermined& undetermined : outcome.undetermined)
    add_undetermined(undetermined, out);
  set_points(outcome.points, *out.mutable_points());
  out.set_rms_before_mm(outcome.rms_before_mm);
  out.set_rms_after_mm(outcome.rms_after_mm);
  out.set_residual_sigma_mm(outcome.residual_sigma_mm);
  out.set_discretisation_mm(outcome.discretisation_mm);
  out.set_degrees_of_freedom(outcome.degrees_of_freedom);
  out.set_student_t(outcome.t_quantile);
  out.set_iterations(outcome.iterations);
  out.set_dips(outcome.dips);
  out.set_settled(outcome.settled);
  set_profile(outcome.profile, *out.mutable_profile());
}

class Fit final : public ReportTask<v1::FitReport> {
 public:
  explicit Fit(FitOptions options) : ReportTask("fit"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override { return options_.dip.object.mesh.string(); }
  [[nodiscard]] std::vector<Stage> stages() const override {
    return {{"inputs", 1}, {"reading", 2}, {"fit", 96}, {"writing", 1}};
  }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    const ObjectOptions& object = options_.dip.object;
    return {{"mesh", object.mesh},
            {"pose", object.pose_file},
            {"profile", options_.dip.profile},
            {"ink_image", options_.ink_image},
            film_file(object.film),
            {"points", options_.points}};
  }

  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;

  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override;

 private:
  [[nodiscard]] Status write(const std::filesystem::path& folder) const;

  FitOptions options_;
  pipeline::DipOptions dip_;
  fit::Outcome outcome_;
};

Status Fit::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  HP_ASSIGN_OR_RETURN(dip_, read_inked_dip(options_.dip, options_.ink_image, run, context));
  HP_RETURN_IF_ERROR(check_cancelled(context));
  HP_ASSIGN_OR_RETURN(const std::vector<fit::Point> points, fit::read_points(options_.points));
  context.progress("reading", 0);
  const ObjectOptions& object = options_.dip.object;
  HP_ASSIGN_OR_RETURN(const mesh::Model model,
                      mesh::read_model(object.mesh, object.scale, context));
  HP_ASSIGN_OR_RETURN(outcome_, fit::fit(model, dip_, points, options_.fit, context));
  set_dip(options_.dip, dip_, outcome_.X_FO, *report_.mutable_parameters());
  set_mesh(model, *report_.mutable_mesh());
  report_.set_drop_outliers(options_.fit.drop_outliers);
  set_outcome(outcome_, report_);
  add_warnings(outcome_.warnings, *run.mutable_warnings());
  context.progress("writing", 0);
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(write(folder.partial()));
  for (const char* name : {"film_profile.toml", "residuals.csv", "residuals.png"})
    run.add_artifacts(name);
  return {};
}

Status Fit::write(const std::filesystem::path& folder) const {
  HP_RETURN_IF_ERROR(
      image::write_artifact(folder / "film_profile.toml", film::profile_toml(outcome_.profile)));
  HP_RETURN_IF_ERROR(
      image::write_artifact(folder / "residuals.csv", residuals_csv(outcome_.points)));
  HP_ASSIGN_OR_RETURN(const image::RgbImage picture, fit::residual_picture(dip_.outline, outcome_));
  return image::write_png(folder / "residuals.png", picture, image::kScreenDpi);
}

std::string Fit::summary(const std::filesystem::path& dir) const {
  std::string out =
      fmt::format("{}/film_profile.toml: residuals {:.3f} mm (rms), {:.3f} mm before the fit\n",
                  dir.string(), outcome_.rms_after_mm, outcome_.rms_before_mm);
  for (const fit::Estimate& e : outcome_.estimates) out += estimate_text(e);
  for (const fit::Undetermined& u : outcome_.undetermined) {
    out += fmt::format("{} is not determined: {}\n", u.name, u.reason);
  }
  return out;
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& inputs) {
  HP_ASSIGN_OR_RETURN(FitOptions options,
                      read_options(static_cast<const v1::FitSpec&>(spec), inputs));
  return std::make_unique<Fit>(std::move(options));
}

}  // namespace

Verb fit_verb() {
  return {"fit",           "Fit a film profile to measured landing points",
          kExamples,       &v1::FitSpec::default_instance(),
          add_field_flags, plan};
}

}  // namespace hydroprint::worker
