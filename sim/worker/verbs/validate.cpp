#include "sim/worker/verbs/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "sim/base/artifact_file.h"
#include "sim/image/io/image_file.h"
#include "sim/validate/html.h"
#include "sim/validate/measure.h"
#include "sim/validate/validate.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/flags.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples = R"(Examples:
  hydroprint-worker validate --out validation                         # then open validation/report.html
  hydroprint-worker validate --only accuracy,bowl --quick --out glance

Exit status: 0 done, even if figures are beyond their limits; 2 bad usage, 4 the computation failed, 130 cancelled.)";

Result<validate::Options> read_options(const v1::ValidateSpec& spec) {
  validate::Options out{{spec.only().begin(), spec.only().end()}, spec.quick()};
  if (const Status known = validate::check(out); !known) {
    return fail_field(known.error().code, "only", known.error().message);
  }
  return out;
}

void set_limit(const validate::Limit& limit, v1::ValidateReport::Limit& out) {
  constexpr double kNone = 1e299;
  if (limit.least > -kNone) out.set_least(limit.least);
  if (limit.most < kNone) out.set_most(limit.most);
  out.set_why(limit.why);
}

void set_figure(const validate::Figure& figure, v1::ValidateReport::Figure& out) {
  out.set_name(figure.name);
  out.set_text(figure.text);
  out.set_unit(figure.unit);
  out.set_value(figure.value);
  if (!figure.limit) return;
  set_limit(*figure.limit, *out.mutable_limit());
  out.set_passed(figure.passes());
}

void set_table(const validate::Table& table, v1::ValidateReport::Table& out) {
  out.set_caption(table.caption);
  add_all(table.header, out.mutable_header());
  for (const auto& row : table.rows) add_all(row, out.add_rows()->mutable_cells());
}

void set_experiment(const validate::Experiment& experiment, v1::ValidateReport::Experiment& out) {
  out.set_name(experiment.name);
  out.set_title(experiment.title);
  out.set_paper(experiment.paper);
  for (const validate::Figure& figure : experiment.figures) set_figure(figure, *out.add_figures());
  for (const validate::Table& table : experiment.tables) set_table(table, *out.add_tables());
  for (const validate::Picture& picture : experiment.pictures) {
    v1::ValidateReport::Picture& added = *out.add_pictures();
    added.set_file(picture.file);
    added.set_caption(picture.caption);
  }
}

class Validate final : public ReportTask<v1::ValidateReport> {
 public:
  explicit Validate(validate::Options options)
      : ReportTask("validate"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override { return "validate"; }
  [[nodiscard]] std::string memory_tip() const override { return "--quick"; }
  /// Returns a stage for each selected experiment, then `writing`.
  [[nodiscard]] std::vector<Stage> stages() const override;

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override { return {}; }

  /// Writes pictures as they are finished and report.html at the end.
  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;

  /// Returns one line for the whole run, and one for each figure beyond its limit.
  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override;

 private:
  validate::Options options_;
  validate::Report validation_;
};

std::vector<Stage> Validate::stages() const {
  std::vector<Stage> out;
  const auto& only = options_.only;
  for (const validate::ExperimentKind& kind : validate::kinds()) {
    if (only.empty() || std::find(only.begin(), only.end(), kind.name) != only.end()) {
      out.push_back({kind.name, kind.weight});
    }
  }
  out.push_back({"writing", 0.1});
  return out;
}

Status Validate::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  HP_RETURN_IF_ERROR(check_cancelled(context));
  HP_RETURN_IF_ERROR(folder.create());
  const auto write_picture = [&](const std::string& file, const image::RgbImage& picture) {
    run.add_artifacts(file);
    return image::write_png(folder.partial() / file, picture, image::kScreenDpi);
  };
  HP_ASSIGN_OR_RETURN(validation_, validate::validate(options_, write_picture, context));
  context.progress("writing", 0);
  add_all(options_.only, report_.mutable_only());
  report_.set_quick(options_.quick);
  report_.set_passed(validation_.passed);
  report_.set_failed(validation_.failed);
  for (const validate::Experiment& experiment : validation_.experiments)
    set_experiment(experiment, *report_.add_experiments());
  run.add_artifacts("report.html");
  return image::write_artifact(folder.partial() / "report.html",
                               validate::report_html(validation_, HYDROPRINT_VERSION));
}

std::string Validate::summary(const std::filesystem::path& dir) const {
  std::string out =
      fmt::format("{}/report.html: {} of {} figures are within their limits\n", dir.string(),
                  validation_.passed, validation_.passed + validation_.failed);
  for (const validate::Experiment& e : validation_.experiments) {
    for (const validate::Figure& f : e.figures) {
      if (f.passes()) continue;
      out += fmt::format("{}: {}: {}{}, not {}\n", e.name, f.text, validate::text_of(f.value, 3),
                         f.unit.empty() ? "" : " " + f.unit, validate::limit_text(f));
    }
  }
  return out;
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& /*inputs*/) {
  HP_ASSIGN_OR_RETURN(validate::Options options,
                      read_options(static_cast<const v1::ValidateSpec&>(spec)));
  return std::make_unique<Validate>(std::move(options));
}

}  // namespace

Verb validate_verb() {
  return {"validate",      "Run the paper's experiments in silico; writes a report with pictures",
          kExamples,       &v1::ValidateSpec::default_instance(),
          add_field_flags, plan};
}

}  // namespace hydroprint::worker
