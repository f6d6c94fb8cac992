#include "sim/worker/verbs/template.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "hydroprint/v1/spec.pb.h"
#include "sim/base/artifact_file.h"
#include "sim/film/outline.h"
#include "sim/mesh/make_surface.h"
#include "sim/mesh/read/read_model.h"
#include "sim/print/pdf.h"
#include "sim/print/placement.h"
#include "sim/worker/common/artifact_task.h"
#include "sim/worker/common/object.h"
#include "sim/worker/common/page.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kExamples =
    R"(placement.pdf shows the film's edge and axes, the part of the object that meets the water first, and the outline of
the whole object, seen from above at exact scale. A further page shows the object's orientation. For a rig without a
camera: print it at 100 %, lay it where the film will float, and position the object over it.

Example:
  hydroprint-worker template --mesh mug.obj --scale 10 --pose pose.json --job-name "mug 7" --out placement

Exit status: 0 done, 2 bad usage, 3 bad input, 4 the computation failed, 130 cancelled.)";

struct TemplateOptions {
  ObjectOptions object;
  print::PageSettings page;
};

Result<TemplateOptions> read_options(const v1::TemplateSpec& spec, const InputFolder& inputs) {
  TemplateOptions out;
  HP_ASSIGN_OR_RETURN(out.object, object_options(spec, inputs));
  HP_ASSIGN_OR_RETURN(out.page, page_settings(spec));
  HP_RETURN_IF_ERROR(print::check(out.page));
  return out;
}

void append(Warnings& warnings, const Warnings& more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

class Template final : public ArtifactTask {
 public:
  explicit Template(TemplateOptions options)
      : ArtifactTask("template"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override { return options_.object.mesh.string(); }
  [[nodiscard]] std::vector<Stage> stages() const override {
    return {{"inputs", 1}, {"reading", 20}, {"surface", 20}, {"pictures", 50}, {"writing", 9}};
  }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    const ObjectOptions& object = options_.object;
    return {{"mesh", object.mesh}, {"pose", object.pose_file}, film_file(object.film)};
  }

  [[nodiscard]] Status compute(OutFolder& folder, Report& report, const Context& context) override;

  [[nodiscard]] Json findings(const Report& report) const override {
    Json parameters = page_parameters_json(options_.page, outline_, report.threads);
    parameters.update({{"scale", options_.object.scale}, {"pose", pose_json(placement_.X_FO)}});
    return {{"parameters", parameters}, {"mesh", mesh_json(mesh_)}, {"placement", figures()}};
  }
  /// Returns where the object first meets the water, in frame F.
  [[nodiscard]] Json figures() const override {
    return {{"contact_mm", pair_of(placement_.contact_mm)},
            {"contact_size_mm", pair_of(placement_.contact_size_mm)},
            {"contact_depth_mm", print::kFirstContact_mm}};
  }
  [[nodiscard]] std::string summary(const Report& report,
                                    const std::filesystem::path& dir) const override;

 private:
  TemplateOptions options_;
  film::Outline outline_;
  MeshSize mesh_;
  print::Placement placement_;  ///< its pages are cleared once they are written
};

Status Template::compute(OutFolder& folder, Report& report, const Context& context) {
  const ObjectOptions& object = options_.object;
  HP_ASSIGN_OR_RETURN(outline_, film::parse_outline(object.film));
  HP_RETURN_IF_ERROR(check_cancelled(context));
  context.progress("reading", 0);
  HP_ASSIGN_OR_RETURN(const mesh::Model model,
                      mesh::read_model(object.mesh, object.scale, context));
  mesh_ = {model.vertices.size(), model.triangles.size()};
  // The model's own triangles are fine enough for a drawing.
  HP_ASSIGN_OR_RETURN(const mesh::Surface surface,
                      mesh::make_surface(model, std::numeric_limits<double>::infinity(), context));
  HP_ASSIGN_OR_RETURN(placement_,
                      print::placement(surface, object.X_FO, outline_, options_.page, context));
  report.warnings = model.warnings;
  append(report.warnings, surface.warnings);
  append(report.warnings, placement_.warnings);
  context.progress("writing", 0);
  HP_ASSIGN_OR_RETURN(const auto file, print::encode_pdf(placement_.document, context));
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(image::write_artifact(folder.partial() / "placement.pdf", file));
  report.artifacts = {"placement.pdf"};
  placement_.document.pages.clear();
  return {};
}

std::string Template::summary(const Report& report, const std::filesystem::path& dir) const {
  return fmt::format(
      "{}first contact near x {:.2f}, y {:.2f} mm; print at 100 %, without fitting to the page\n",
      artifacts_line(dir, report), placement_.contact_mm.x(), placement_.contact_mm.y());
}

Result<std::unique_ptr<Task>> plan(const google::protobuf::Message& spec,
                                   const InputFolder& inputs) {
  HP_ASSIGN_OR_RETURN(TemplateOptions options,
                      read_options(static_cast<const v1::TemplateSpec&>(spec), inputs));
  return std::make_unique<Template>(std::move(options));
}

}  // namespace

Verb template_verb() {
  return {"template",      "Draw a page for placing the object over the film without a camera",
          kExamples,       &v1::TemplateSpec::default_instance(),
          add_field_flags, plan};
}

}  // namespace hydroprint::worker
