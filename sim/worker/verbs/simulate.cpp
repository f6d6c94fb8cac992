#include "sim/worker/verbs/simulate.h"

#include <fmt/format.h>

#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/warning_message.h"
#include "sim/image/io/image_file.h"
#include "sim/pipeline/simulate.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/artifact_writer.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/film_flow.h"
#include "sim/worker/common/paint.h"
#include "sim/worker/common/plan_file.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples = R"(Examples:
  hydroprint-worker simulate --mesh spot.obj --texture spot.png --scale 50 --out spot-film
  hydroprint-worker simulate --mesh cat.stl --texture fur.png --project box --project-size-mm 60 --out cat-film
  hydroprint-worker simulate --mesh mug.obj --scale 10 --pose pose.json --film A3 --dpi 600 --out mug
  hydroprint-worker simulate --mesh spot.obj --texture spot.png --plan plan --immersion 2 --pose hung.json --out second
  hydroprint-worker simulate --mesh ball.ply --film circle:105 --depth-mm 40 --artifacts map --out map

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

struct SimulateOptions {
  FlowOptions flow;
  PaintOptions paint;
  PlannedDipOptions plan;
};

void add_flags(Flags& flags) {
  flags.add_fields();
  add_plan_flag(flags);
}

Result<SimulateOptions> read_options(v1::SimulateSpec spec, const InputFolder& inputs) {
  SimulateOptions out;
  HP_ASSIGN_OR_RETURN(out.plan, take_plan(inputs, spec));
  HP_ASSIGN_OR_RETURN(out.flow, flow_options(spec, inputs));
  if (spec.has_tolerance_mm()) out.flow.tolerance_mm = spec.tolerance_mm();
  HP_ASSIGN_OR_RETURN(out.paint, paint_options(spec, inputs));
  return out;
}

/// Sets the dip of a plan.
void set_planned_dip(const pipeline::PlanDeviation& deviation, const pipeline::PlanShare& share,
                     v1::SimulateReport::PlannedDip& out) {
  out.set_immersion(share.dip);
  out.set_immersions(static_cast<std::int32_t>(share.X_FO.size()));
  set_pose(share.X_FO[static_cast<std::size_t>(share.dip - 1)], *out.mutable_planned_pose());
  out.set_turn_deg(deviation.turn_rad * 180 / std::numbers::pi);
  add_all(deviation.shift_mm, out.mutable_shift_mm());
  out.set_lost_share(deviation.lost_share);
  out.set_seam_shift_mm(deviation.seam_shift_mm);
}

class Simulate final : public ReportTask<v1::SimulateReport> {
 public:
  explicit Simulate(SimulateOptions options)
      : ReportTask("simulate"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override {
    return options_.flow.dip.object.mesh.string();
  }
  [[nodiscard]] std::string memory_tip() const override { return "a smaller model, a lower --dpi"; }
  [[nodiscard]] std::vector<Stage> stages() const override {
    return simulate_stages(options_.flow, has_plan());
  }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    const ObjectOptions& object = options_.flow.dip.object;
    std::vector<InputPath> out = {{"mesh", object.mesh}};
    out.insert(out.end(), options_.paint.files.begin(), options_.paint.files.end());
    out.insert(out.end(), {{"plan", options_.plan.plan_json},
                           {"plan", options_.plan.plan_ply},
                           {"pose", object.pose_file},
                           {"profile", options_.flow.dip.profile},
                           {"ink_image", options_.flow.ink_image},
                           film_file(object.film)});
    return out;
  }

  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;

  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override {
    return flow_summary(dir, report_.run(), report_.flow());
  }

 private:
  [[nodiscard]] bool has_plan() const { return !options_.plan.plan_json.empty(); }
  [[nodiscard]] Status check_mesh(const v1::RunFacts& run) const;
  [[nodiscard]] pipeline::SimulateOptions pipeline_options(pipeline::DipOptions dip) const;
  [[nodiscard]] std::vector<FileTask> files(const pipeline::Simulation& simulation,
                                            const Context& context) const;

  SimulateOptions options_;
};

pipeline::SimulateOptions Simulate::pipeline_options(pipeline::DipOptions dip) const {
  const FlowOptions& flow = options_.flow;
  pipeline::SimulateOptions out;
  out.mesh = flow.dip.object.mesh;
  out.scale = flow.dip.object.scale;
  out.paint = options_.paint.source;
  out.dip = std::move(dip);
  out.dpi = flow.dpi;
  out.ink_passes = flow.passes();
  out.images = !flow.map_only;
  out.needs_colour = flow.ink_image.empty();  // --ink-image is the film's print
  return out;
}

/// The hash of the mesh file must be that of the plan's.
Status Simulate::check_mesh(const v1::RunFacts& run) const {
  if (!has_plan() || run.inputs(0).sha256() == options_.plan.mesh_sha256) return {};
  return fail(
      Code::kInvalidArgument,
      fmt::format("{}: not the mesh of the plan {}. Use the same file, or make another plan",
                  subject(), options_.plan.plan_json.string()));
}

std::vector<FileTask> Simulate::files(const pipeline::Simulation& simulation,
                                      const Context& context) const {
  std::vector<FileTask> out = {surface_map_file(simulation.dip)};
  if (!simulation.images) return out;
  const pipeline::SimulatedImages& images = *simulation.images;
  out.push_back(png_file("film.png", images.film, options_.flow.dpi, context));
  if (images.complete) {
    out.push_back(png_file("complete.png", *images.complete, options_.flow.dpi, context));
    out.push_back(png_file("mask.png", *images.mask, options_.flow.dpi, context));
  }
  out.emplace_back("film_map.exr", [&images](const std::filesystem::path& path) {
    return image::write_film_map_exr(path, images.film_map);
  });
  out.push_back(png_file("stretch.png", images.stretch, image::kScreenDpi, context));
  out.push_back(png_file("error.png", images.error, image::kScreenDpi, context));
  if (images.wrinkles) {
    out.push_back(png_file("wrinkles.png", *images.wrinkles, image::kScreenDpi, context));
  }
  out.push_back(png_file("predicted.png", images.predicted, image::kScreenDpi, context));
  return out;
}

Status Simulate::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  HP_ASSIGN_OR_RETURN(pipeline::DipOptions dip, read_flow(options_.flow, run, context));
  if (!options_.flow.map_only) {
    HP_RETURN_IF_ERROR(check_film_image(dip.outline, options_.flow.dpi));
  }
  HP_RETURN_IF_ERROR(check_cancelled(context));
  HP_RETURN_IF_ERROR(check_mesh(run));
  pipeline::SimulateOptions options = pipeline_options(std::move(dip));
  if (has_plan()) {
    HP_ASSIGN_OR_RETURN(options.share, read_share(options_.plan));
  }
  HP_ASSIGN_OR_RETURN(const pipeline::Simulation simulation, pipeline::simulate(options, context));
  set_findings(options_.flow, options.dip, simulation.model, simulation.dip, report_);
  add_layers(simulation.layers, report_);
  if (simulation.deviation)
    set_planned_dip(*simulation.deviation, options_.plan.share, *report_.mutable_plan());
  add_warnings(options_.flow.dip.object.pose_warnings, *run.mutable_warnings());
  add_warnings(simulation.warnings, *run.mutable_warnings());
  if (!options_.flow.map_only && options_.paint.shows_own_colours())
    HP_RETURN_IF_ERROR(add_material_textures(simulation.model, run));
  if (simulation.images) {
    report_.mutable_parameters()->add_film_image_px(simulation.images->film.width);
    report_.mutable_parameters()->add_film_image_px(simulation.images->film.height);
  }
  HP_RETURN_IF_ERROR(folder.create());
  HP_ASSIGN_OR_RETURN(const auto names,
                      write_files(folder.partial(), files(simulation, context), context));
  add_all(names, run.mutable_artifacts());
  return {};
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& inputs) {
  HP_ASSIGN_OR_RETURN(SimulateOptions options,
                      read_options(static_cast<const v1::SimulateSpec&>(spec), inputs));
  return std::make_unique<Simulate>(std::move(options));
}

}  // namespace

Verb simulate_verb() {
  return {"simulate", "Compute the film image to print from a textured model",
          kExamples,  &v1::SimulateSpec::default_instance(),
          add_flags,  plan};
}

}  // namespace hydroprint::worker
