#include "sim/worker/verbs/inspect.h"

#include <string>
#include <utility>
#include <vector>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/model_summary_text.h"
#include "sim/base/artifact_file.h"
#include "sim/pipeline/read_inputs.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/flags.h"
#include "sim/worker/common/input_folder.h"
#include "sim/worker/inspection/inspection.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples =
    R"(model.glb shows the model with the colours that simulate would print: binary glTF, in mm, thinned to 200,000 triangles.
report.json states format, sizes, the likely unit, each material with the source of its colour, and warnings.

Example:
  hydroprint-worker inspect --mesh spot.obj --scale 50 --out spot

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

struct InspectOptions {
  std::filesystem::path mesh;
  double scale = 1;
  bool shape_only = false;
};

class Inspect final : public ArtifactTask {
 public:
  explicit Inspect(InspectOptions options)
      : ArtifactTask("inspect"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override { return options_.mesh.string(); }
  [[nodiscard]] std::vector<Stage> stages() const override {
    return {
        {"inputs", 0.05}, {"reading", 0.4}, {"colours", 0.2}, {"display", 0.3}, {"writing", 0.05}};
  }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    return {{"mesh", options_.mesh}};
  }
  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;
  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override {
    return artifacts_line(dir, run_) + model_summary_text(summary_);
  }
  [[nodiscard]] google::protobuf::Message& report() override { return summary_; }
  [[nodiscard]] v1::RunFacts& run_facts() override { return run_; }

 private:
  InspectOptions options_;
  v1::ModelSummary summary_;
  v1::RunFacts run_;  ///< not in report.json
};

Status Inspect::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  const pipeline::ModelInput input{options_.mesh, options_.scale, options_.shape_only, true};
  HP_ASSIGN_OR_RETURN(const mesh::Model model, pipeline::read_inputs(input, context));
  HP_ASSIGN_OR_RETURN(Inspection found, inspect_model(model, options_.shape_only, context));
  summary_ = std::move(found.summary);
  *run.mutable_warnings() = summary_.warnings();
  HP_RETURN_IF_ERROR(folder.create());
  context.progress("writing", 0);
  run.add_artifacts("model.glb");
  return image::write_artifact(folder.partial() / "model.glb", found.glb);
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& message,
                                   const InputFolder& inputs) {
  const auto& spec = static_cast<const v1::InspectSpec&>(message);
  InspectOptions options;
  HP_ASSIGN_OR_RETURN(options.mesh, inputs.required("mesh", spec.mesh()));
  if (spec.has_scale()) options.scale = spec.scale();
  options.shape_only = spec.shape_only();
  return std::make_unique<Inspect>(std::move(options));
}

}  // namespace

Verb inspect_verb() {
  return {"inspect",       "Show how a model is understood: sizes, materials, colours",
          kExamples,       &v1::InspectSpec::default_instance(),
          add_field_flags, plan};
}

}  // namespace hydroprint::worker
