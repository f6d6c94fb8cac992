#include "sim/worker/verbs/template.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/warning_message.h"
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

class Template final : public ReportTask<v1::TemplateReport> {
 public:
  explicit Template(TemplateOptions options)
      : ReportTask("template"), options_(std::move(options)) {}

  [[nodiscard]] std::string subject() const override { return options_.object.mesh.string(); }
  [[nodiscard]] std::vector<Stage> stages() const override {
    return {{"inputs", 1}, {"reading", 20}, {"surface", 20}, {"pictures", 50}, {"writing", 9}};
  }

 protected:
  [[nodiscard]] std::vector<InputPath> input_files() const override {
    const ObjectOptions& object = options_.object;
    return {{"mesh", object.mesh}, {"pose", object.pose_file}, film_file(object.film)};
  }

  [[nodiscard]] Status compute(OutFolder& folder, v1::RunFacts& run,
                               const Context& context) override;

  [[nodiscard]] std::string summary(const std::filesystem::path& dir) const override;

 private:
  TemplateOptions options_;
};

Status Template::compute(OutFolder& folder, v1::RunFacts& run, const Context& context) {
  const ObjectOptions& object = options_.object;
  HP_ASSIGN_OR_RETURN(const film::Outline outline, film::parse_outline(object.film));
  HP_RETURN_IF_ERROR(check_cancelled(context));
  context.progress("reading", 0);
  HP_ASSIGN_OR_RETURN(const mesh::Model model,
                      mesh::read_model(object.mesh, object.scale, context));
  // The model's own triangles are fine enough for a drawing.
  HP_ASSIGN_OR_RETURN(const mesh::Surface surface,
                      mesh::make_surface(model, std::numeric_limits<double>::infinity(), context));
  HP_ASSIGN_OR_RETURN(const print::Placement placement,
                      print::placement(surface, object.X_FO, outline, options_.page, context));
  set_page(options_.page, outline, *report_.mutable_page());
  report_.set_scale(object.scale);
  set_pose(placement.X_FO, *report_.mutable_pose());
  set_mesh(model, *report_.mutable_mesh());
  add_all(placement.contact_mm, report_.mutable_contact_mm());
  add_all(placement.contact_size_mm, report_.mutable_contact_size_mm());
  report_.set_contact_depth_mm(print::kFirstContact_mm);
  for (const Warnings& warnings : {model.warnings, surface.warnings, placement.warnings})
    add_warnings(warnings, *run.mutable_warnings());
  context.progress("writing", 0);
  HP_ASSIGN_OR_RETURN(const auto file, print::encode_pdf(placement.document, context));
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(image::write_artifact(folder.partial() / "placement.pdf", file));
  run.add_artifacts("placement.pdf");
  return {};
}

std::string Template::summary(const std::filesystem::path& dir) const {
  return fmt::format(
      "{}first contact near x {:.2f}, y {:.2f} mm; print at 100 %, without fitting to the page\n",
      artifacts_line(dir, report_.run()), report_.contact_mm(0), report_.contact_mm(1));
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
