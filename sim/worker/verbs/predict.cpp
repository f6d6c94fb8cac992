#include "sim/worker/verbs/predict.h"

#include <string>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/warning_message.h"
#include "sim/image/io/image_file.h"
#include "sim/pipeline/predict.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/artifact_writer.h"
#include "sim/worker/common/film_flow.h"
#include "sim/worker/common/motion_file.h"
#include "sim/worker/common/surface_ply.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples = R"(Examples:
  hydroprint-worker predict --mesh spot.obj --film-image film.png --scale 50 --out landed
  hydroprint-worker predict --mesh spot.obj --film-image film.png --pose true.json --motion driven.csv --out landed

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

struct PredictOptions {
  FlowOptions flow;
  std::filesystem::path film_image;
  std::filesystem::path motion;  ///< empty: straight down
};

Result<PredictOptions> read_options(const v1::PredictSpec& spec, const InputFolder& inputs) {
  PredictOptions out;
  HP_ASSIGN_OR_RETURN(out.flow, flow_options(spec, inputs));
  HP_ASSIGN_OR_RETURN(out.film_image, inputs.required("film_image", spec.film_image()));
  out.motion = inputs.path(spec.motion());
  return out;
}

class Predict final : public ReportTask<v1::PredictReport> {
 public:
  explicit Predict(PredictOptions options) : ReportTask("predict"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override {
    return options_.flow.dip.object.mesh.string();
  }
  [[nodiscard]] std::string memory_tip() const override { return "a smaller model, a lower --dpi"; }
  [[nodiscard]] std::vector<Stage> stages() const override { return predict_stages(options_.flow); }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    const ObjectOptions& object = options_.flow.dip.object;
    return {{"mesh", object.mesh},
            {"film_image", options_.film_image},
            {"pose", object.pose_file},
            {"profile", options_.flow.dip.profile},
            {"ink_image", options_.flow.ink_image},
            film_file(object.film),
            {"motion", options_.motion}};
  }

  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;

  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override {
    return flow_summary(dir, report_.run(), report_.flow());
  }

 private:
  PredictOptions options_;
};

std::vector<FileTask> files(const pipeline::Prediction& prediction, const Context& context) {
  if (!prediction.images) return {surface_map_file(prediction.dip)};
  const pipeline::PredictedImages& images = *prediction.images;
  std::vector<FileTask> out = {{"landed.ply", [&](const std::filesystem::path& path) {
                                  return write_landed(path, prediction.dip.surface, images.landed);
                                }}};
  if (images.texture) {
    out.emplace_back("landed.png", [&images](const std::filesystem::path& path) {
      return image::write_png_rgba(path, images.texture->width, images.texture->height,
                                   images.texture->rgba);
    });
  }
  out.push_back(png_file("predicted.png", images.picture, image::kScreenDpi, context));
  return out;
}

Status Predict::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  pipeline::PredictOptions options;
  HP_ASSIGN_OR_RETURN(options.dip, read_flow(options_.flow, run, context));
  if (!options_.motion.empty()) {
    HP_ASSIGN_OR_RETURN(options.dip.motion, read_motion(options_.motion));
  }
  HP_RETURN_IF_ERROR(check_cancelled(context));
  options.mesh = options_.flow.dip.object.mesh;
  options.scale = options_.flow.dip.object.scale;
  options.film_image = options_.film_image;
  options.ink_passes = options_.flow.passes();
  options.images = !options_.flow.map_only;
  HP_ASSIGN_OR_RETURN(const pipeline::Prediction prediction, pipeline::predict(options, context));
  set_findings(options_.flow, options.dip, prediction.model, prediction.dip, report_);
  add_warnings(prediction.warnings, *run.mutable_warnings());
  HP_RETURN_IF_ERROR(folder.create());
  HP_ASSIGN_OR_RETURN(const auto names,
                      write_files(folder.partial(), files(prediction, context), context));
  add_all(names, run.mutable_artifacts());
  return {};
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& inputs) {
  HP_ASSIGN_OR_RETURN(PredictOptions options,
                      read_options(static_cast<const v1::PredictSpec&>(spec), inputs));
  return std::make_unique<Predict>(std::move(options));
}

}  // namespace

Verb predict_verb() {
  return {"predict",       "Predict the colours that a printed film image leaves on the object",
          kExamples,       &v1::PredictSpec::default_instance(),
          add_field_flags, plan};
}

}  // namespace hydroprint::worker
