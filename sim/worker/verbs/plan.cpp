#include "sim/worker/verbs/plan.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hydroprint/v1/report.pb.h"
#include "proto/warning_message.h"
#include "sim/base/number_text.h"
#include "sim/image/io/image_file.h"
#include "sim/pipeline/plan.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/artifact_writer.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/film_flow.h"
#include "sim/worker/common/paint.h"
#include "sim/worker/common/report_values.h"
#include "sim/worker/common/surface_ply.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples =
    R"(Each point of the object is printed by the dip that stretches the film least there, and the pictures of two dips blend
where they meet. For each dip N: film-N.png is the image to print; stretch-N.png, complete-N.png and mask-N.png show how
it was made. combined.png shows the object after all dips.

three.json: a list of poses, each with its depth:
  [{"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0], "depth_mm": "full"},
   {"rotation_wxyz": [0, 1, 0, 0], "translation_mm": [0, 0, 0], "depth_mm": 40}]

Examples:
  hydroprint-worker plan --mesh spot.obj --texture spot.png --scale 50 --immersions three.json --out plan
  hydroprint-worker plan --mesh ball.obj --film circle:105 --immersions two.json --blend-mm 8 --out plan

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

/// Options of a plan: those of one dip without its pose and depth, and the dips.
struct PlanVerbOptions {
  FlowOptions flow;
  PaintOptions paint;
  std::filesystem::path immersions_file;  ///< empty: not from a file
  std::vector<pipeline::Immersion> immersions;
  Warnings pose_warnings;
  double blend_mm = plan::kBlend_mm;
  v1::Plan plan;  ///< without mesh_sha256, and with the poses as given
};

/// Sets every field of a film that is not set to its default.
void fill_defaults(const FlowOptions& flow, v1::FilmSetup& film) {
  film.set_film(flow.dip.object.film);
  film.set_dip_speed_mm_per_s(flow.dip.dip_speed_mm_per_s);
  film.set_model(flow.is_sheet() ? v1::MODEL_SHEET : v1::MODEL_STOKES);
  film.set_ink_passes(flow.is_sheet() ? flow.passes() : 0);
}

/// Reads the options of the film, except its profile's content.
Status read_film(const v1::FilmSetup& film, const InputFolder& inputs, FlowOptions& out) {
  HP_ASSIGN_OR_RETURN(out.dip.object.film, film_of(film, inputs));
  out.dip.profile = inputs.path(film.profile());
  if (film.has_dip_speed_mm_per_s()) out.dip.dip_speed_mm_per_s = film.dip_speed_mm_per_s();
  if (film.has_ink_passes()) out.ink_passes = film.ink_passes();
  if (film.has_tolerance_mm()) out.tolerance_mm = film.tolerance_mm();
  return choose(out, film.model(), film.inertia(), v1::ARTIFACT_SET_ALL);
}

Result<FlowOptions> read_flow_options(const v1::PlanSpec& spec, const InputFolder& inputs) {
  FlowOptions out;
  HP_ASSIGN_OR_RETURN(out.dip.object.mesh, inputs.required("object.mesh", spec.object().mesh()));
  if (spec.object().has_scale()) out.dip.object.scale = spec.object().scale();
  if (spec.has_dpi()) out.dpi = spec.dpi();
  const Status read = read_film(spec.film(), inputs, out);
  if (!read) return tl::unexpected(in_message("film", read.error()));
  return out;
}

Status read_immersions(const v1::PlanSpec& spec, PlanVerbOptions& out) {
  if (spec.immersions().empty())
    return fail_field(Code::kInvalidArgument, "immersions", "no dips. List at least one");
  for (const v1::DipSetup& dip : spec.immersions()) {
    pipeline::Immersion& immersion = out.immersions.emplace_back();
    if (dip.has_depth_mm()) immersion.depth_mm = dip.depth_mm();
    if (!dip.has_pose()) continue;
    HP_ASSIGN_OR_RETURN(immersion.X_FO, pose_of(dip.pose()));
    for (Warning& warning : pose_warnings_of(dip.pose())) {
      warning.where.dip = static_cast<int>(out.immersions.size());
      out.pose_warnings.push_back(std::move(warning));
    }
  }
  return {};
}

Result<PlanVerbOptions> read_options(const v1::PlanSpec& spec, const InputFolder& inputs) {
  PlanVerbOptions out;
  HP_ASSIGN_OR_RETURN(out.flow, read_flow_options(spec, inputs));
  HP_ASSIGN_OR_RETURN(out.paint, paint_options(spec.object(), inputs, "object"));
  out.immersions_file = inputs.pose_file();
  HP_RETURN_IF_ERROR(read_immersions(spec, out));
  if (spec.has_blend_mm()) out.blend_mm = spec.blend_mm();
  out.plan.set_scale(out.flow.dip.object.scale);
  *out.plan.mutable_film() = spec.film();
  fill_defaults(out.flow, *out.plan.mutable_film());
  out.plan.set_dpi(out.flow.dpi);
  out.plan.set_blend_mm(out.blend_mm);
  *out.plan.mutable_immersions() = spec.immersions();
  return out;
}

void add_dips(const pipeline::Plan& plan, const std::vector<pipeline::DipPrint>& prints,
              v1::PlanReport& out) {
  const double area_mm2 = pipeline::surface_area_mm2(plan);
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    v1::PlanReport::Dip& dip = *out.add_immersions();
    const pipeline::DipFigures& figures = plan.dips[k].figures;
    const plan::RegionSize& region = plan.regions.sizes[k];
    dip.set_depth_mm(figures.depth_mm);
    dip.set_stopped_at_film_edge(figures.stopped_at_edge);
    dip.set_reached_share(figures.coverage);
    dip.set_share(area_mm2 > 0 ? region.area_mm2 / area_mm2 : 0);
    dip.set_area_mm2(region.area_mm2);
    dip.set_pieces(region.pieces);
    set_stretch(stretch_of(plan, prints, static_cast<int>(k) + 1), *dip.mutable_stretch());
    v1::MapError& error = *dip.mutable_error();
    if (prints[k].own.error) set_error(*prints[k].own.error, error);
  }
}

void set_findings(const pipeline::Plan& plan, const std::vector<pipeline::DipPrint>& prints,
                  v1::PlanReport& out) {
  set_mesh(plan.model, *out.mutable_mesh());
  set_surface(plan.surface, *out.mutable_mesh());
  add_dips(plan, prints, out);
  out.set_unreached_share(plan.regions.unreached_share);
  set_stretch(stretch_of(plan, prints, 0), *out.mutable_stretch());
  out.set_seam_mm(plan.regions.seam_mm);
}

class PlanTask final : public ReportTask<v1::PlanReport> {
 public:
  explicit PlanTask(PlanVerbOptions options) : ReportTask("plan"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override {
    return options_.flow.dip.object.mesh.string();
  }
  [[nodiscard]] std::string memory_tip() const override { return "a smaller model, a lower --dpi"; }
  [[nodiscard]] std::vector<Stage> stages() const override {
    return plan_stages(options_.flow, options_.immersions.size());
  }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    const ObjectOptions& object = options_.flow.dip.object;
    std::vector<InputPath> out = {{"mesh", object.mesh}};
    out.insert(out.end(), options_.paint.files.begin(), options_.paint.files.end());
    out.insert(out.end(), {{"immersions", options_.immersions_file},
                           {"profile", options_.flow.dip.profile},
                           film_file(object.film)});
    return out;
  }

  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;
  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override;

 private:
  [[nodiscard]] pipeline::PlanOptions pipeline_options(pipeline::DipOptions dip) const;
  [[nodiscard]] Status write_plan_files(const pipeline::Plan& plan,
                                        const std::filesystem::path& folder);
  [[nodiscard]] Result<std::vector<pipeline::DipPrint>> print_dips(
      const pipeline::Plan& plan, const pipeline::PlanOptions& options,
      const std::filesystem::path& folder, v1::RunFacts& run, const Context& context) const;

  PlanVerbOptions options_;
};

pipeline::PlanOptions PlanTask::pipeline_options(pipeline::DipOptions dip) const {
  const FlowOptions& flow = options_.flow;
  pipeline::PlanOptions out;
  out.mesh = flow.dip.object.mesh;
  out.scale = flow.dip.object.scale;
  out.paint = options_.paint.source;
  out.dip = std::move(dip);
  out.immersions = options_.immersions;
  out.dpi = flow.dpi;
  out.ink_passes = flow.is_sheet() ? flow.passes() : 0;
  out.blend_mm = options_.blend_mm;
  return out;
}

Status PlanTask::write_plan_files(const pipeline::Plan& plan, const std::filesystem::path& folder) {
  HP_RETURN_IF_ERROR(write_message(folder / "plan.json", *report_.mutable_parameters()));
  return write_plan(folder / "plan.ply", plan);
}

/// Prints one dip after the other, and writes its images before the next one needs the memory;
/// then the picture of all dips.
Result<std::vector<pipeline::DipPrint>> PlanTask::print_dips(const pipeline::Plan& plan,
                                                             const pipeline::PlanOptions& options,
                                                             const std::filesystem::path& folder,
                                                             v1::RunFacts& run,
                                                             const Context& context) const {
  std::vector<pipeline::DipPrint> out;
  image::LandedInk ink;
  for (int n = 1; n <= static_cast<int>(plan.dips.size()); ++n) {
    HP_ASSIGN_OR_RETURN(pipeline::DipPrint print, pipeline::print_dip(plan, options, n, context));
    const pipeline::DipImages& images = print.images;
    const auto file = [&](const char* name, const image::RgbImage& image, double dpi) {
      return png_file(fmt::format("{}-{}.png", name, n), image, dpi, context);
    };
    HP_ASSIGN_OR_RETURN(const auto names,
                        write_files(folder,
                                    {file("stretch", print.stretch, image::kScreenDpi),
                                     file("complete", images.complete, options.dpi),
                                     file("mask", images.mask, options.dpi),
                                     file("film", images.film, options.dpi)},
                                    context));
    add_all(names, run.mutable_artifacts());
    add_warnings(print.warnings, *run.mutable_warnings());
    image::add_ink(print.ink, ink);
    print.images = {};
    print.stretch = {};
    print.ink = {};
    out.push_back(std::move(print));
  }
  HP_ASSIGN_OR_RETURN(const image::RgbImage combined,
                      pipeline::combined_picture(plan, ink, context));
  HP_ASSIGN_OR_RETURN(
      const auto names,
      write_files(folder, {png_file("combined.png", combined, image::kScreenDpi, context)},
                  context));
  add_all(names, run.mutable_artifacts());
  return out;
}

Status PlanTask::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  HP_ASSIGN_OR_RETURN(pipeline::DipOptions dip, read_flow(options_.flow, run, context));
  HP_RETURN_IF_ERROR(check_film_image(dip.outline, options_.flow.dpi));
  HP_RETURN_IF_ERROR(check_cancelled(context));
  const pipeline::PlanOptions options = pipeline_options(std::move(dip));
  HP_ASSIGN_OR_RETURN(const pipeline::Plan plan, pipeline::make_plan(options, context));
  add_warnings(options_.pose_warnings, *run.mutable_warnings());
  add_warnings(plan.warnings, *run.mutable_warnings());
  if (options_.paint.shows_own_colours())
    HP_RETURN_IF_ERROR(add_material_textures(plan.model, run));

  *report_.mutable_parameters() = options_.plan;
  report_.mutable_parameters()->set_mesh_sha256(run.inputs(0).sha256());
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    v1::DipSetup& made = *report_.mutable_parameters()->mutable_immersions(static_cast<int>(k));
    set_pose(plan.dips[k].X_FO, *made.mutable_pose());
  }
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(write_plan_files(plan, folder.partial()));
  for (const char* name : {"plan.json", "plan.ply"}) run.add_artifacts(name);
  HP_ASSIGN_OR_RETURN(const auto prints, print_dips(plan, options, folder.partial(), run, context));
  set_findings(plan, prints, report_);
  return {};
}

std::string PlanTask::summary(const std::filesystem::path& dir) const {
  std::string out = artifacts_line(dir, report_.run());
  for (int k = 0; k < report_.immersions_size(); ++k) {
    const v1::PlanReport::Dip& of_dip = report_.immersions(k);
    out += of_dip.pieces() == 0
               ? fmt::format("dip {}: prints nothing\n", k + 1)
               : fmt::format("dip {}: prints {} of the surface, maximum stretch {}\n", k + 1,
                             percent(of_dip.share()), three_digits(of_dip.stretch().max()));
  }
  return out + fmt::format("no dip reaches {} of the surface; {:.1f} s\n",
                           percent(report_.unreached_share()), report_.run().total_seconds());
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& inputs) {
  HP_ASSIGN_OR_RETURN(PlanVerbOptions options,
                      read_options(static_cast<const v1::PlanSpec&>(spec), inputs));
  return std::make_unique<PlanTask>(std::move(options));
}

}  // namespace

Verb plan_verb() {
  return {"plan",          "Divide one picture among several dips of an object",
          kExamples,       &v1::PlanSpec::default_instance(),
          add_field_flags, plan};
}

}  // namespace hydroprint::worker
