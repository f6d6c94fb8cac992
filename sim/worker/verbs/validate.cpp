#include "sim/worker/verbs/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "hydroprint/v1/spec.pb.h"
#include "sim/base/artifact_file.h"
#include "sim/image/io/image_file.h"
#include "sim/validate/html.h"
#include "sim/validate/measure.h"
#include "sim/validate/validate.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/flags.h"

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

Json limit_json(const validate::Limit& limit) {
  constexpr double kNone = 1e299;
  Json out = Json::object();
  if (limit.least > -kNone) out["least"] = limit.least;
  if (limit.most < kNone) out["most"] = limit.most;
  out["why"] = limit.why;
  return out;
}

Json figure_json(const validate::Figure& f) {
  Json out = {{"name", f.name}, {"text", f.text}, {"unit", f.unit}, {"value", f.value}};
  if (f.limit) {
    out["limit"] = limit_json(*f.limit);
    out["passed"] = f.passes();
  }
  return out;
}

Json experiment_json(const validate::Experiment& e) {
  Json figures = Json::array(), tables = Json::array(), pictures = Json::array();
  for (const auto& f : e.figures) figures.push_back(figure_json(f));
  for (const auto& t : e.tables) {
    tables.push_back({{"caption", t.caption}, {"header", t.header}, {"rows", t.rows}});
  }
  for (const auto& p : e.pictures) pictures.push_back({{"file", p.file}, {"caption", p.caption}});
  return {{"name", e.name},     {"title", e.title}, {"paper", e.paper},
          {"figures", figures}, {"tables", tables}, {"pictures", pictures}};
}

Json experiments_json(const validate::Report& report) {
  Json out = Json::array();
  for (const validate::Experiment& e : report.experiments) out.push_back(experiment_json(e));
  return out;
}

class Validate final : public ArtifactTask {
 public:
  explicit Validate(validate::Options options)
      : ArtifactTask("validate"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override { return "validate"; }
  [[nodiscard]] std::string memory_tip() const override { return "--quick"; }
  /// Returns a stage for each selected experiment, then `writing`.
  [[nodiscard]] std::vector<Stage> stages() const override;

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override { return {}; }

  /// Writes pictures as they are finished and report.html at the end.
  [[nodiscard]] Status compute(OutFolder& folder, Report& report, const Context& context) override;

  [[nodiscard]] Json findings(const Report& report) const override {
    return {{"parameters",
             {{"only", options_.only}, {"quick", options_.quick}, {"threads", report.threads}}},
            {"passed", validation_.passed},
            {"failed", validation_.failed},
            {"experiments", experiments_json(validation_)}};
  }
  [[nodiscard]] Json figures() const override {
    return {{"passed", validation_.passed}, {"failed", validation_.failed}};
  }
  /// Returns one line for the whole run, and one for each figure beyond its limit.
  [[nodiscard]] std::string summary(const Report& report,
                                    const std::filesystem::path& dir) const override;

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

Status Validate::compute(OutFolder& folder, Report& report, const Context& context) {
  HP_RETURN_IF_ERROR(check_cancelled(context));
  HP_RETURN_IF_ERROR(folder.create());
  const auto write_picture = [&](const std::string& file, const image::RgbImage& picture) {
    report.artifacts.push_back(file);
    return image::write_png(folder.partial() / file, picture, image::kScreenDpi);
  };
  HP_ASSIGN_OR_RETURN(validation_, validate::validate(options_, write_picture, context));
  context.progress("writing", 0);
  report.artifacts.emplace_back("report.html");
  return image::write_artifact(folder.partial() / "report.html",
                               validate::report_html(validation_, HYDROPRINT_VERSION));
}

std::string Validate::summary(const Report& /*report*/, const std::filesystem::path& dir) const {
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
