#include "sim/worker/template.h"

#include <limits>
#include <utility>

#include "sim/image/artifact_file.h"
#include "sim/mesh/make_surface.h"
#include "sim/mesh/read_model.h"
#include "sim/print/pdf.h"
#include "sim/print/placement.h"

namespace hydroprint::worker {

std::vector<Stage> template_stages() {
  return {{"inputs", 1}, {"reading", 20}, {"surface", 20}, {"pictures", 50}, {"writing", 9}};
}

Status run_template(const Options& options, const pipeline::DipOptions& dip, OutFolder& folder,
                    Report& report, const Context& context) {
  context.progress("reading", 0);
  HP_ASSIGN_OR_RETURN(const mesh::Model model,
                      mesh::read_model(options.mesh, options.scale, context));
  report.mesh_vertices = model.vertices.size();
  report.mesh_triangles = model.triangles.size();
  // A drawing needs no finer triangles than the model's own.
  HP_ASSIGN_OR_RETURN(const mesh::Surface surface,
                      mesh::make_surface(model, std::numeric_limits<double>::infinity(), context));
  HP_ASSIGN_OR_RETURN(print::Placement placement, print::placement(surface, dip.X_FO, dip.outline,
                                                                   options.print.page, context));
  report.X_FO = placement.X_FO;
  report.warnings = model.warnings;
  report.warnings.insert(report.warnings.end(), surface.warnings.begin(), surface.warnings.end());
  report.warnings.insert(report.warnings.end(), placement.warnings.begin(),
                         placement.warnings.end());
  context.progress("writing", 0);
  HP_ASSIGN_OR_RETURN(const auto file, print::encode_pdf(placement.document, context));
  HP_RETURN_IF_ERROR(folder.create());
  HP_RETURN_IF_ERROR(image::write_artifact(folder.partial() / "placement.pdf", file));
  report.artifacts = {"placement.pdf"};
  placement.document.pages.clear();
  report.placement = std::move(placement);
  return {};
}

}  // namespace hydroprint::worker
