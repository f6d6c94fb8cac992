#include "sim/worker/inspection/inspection.h"

#include <utility>

#include "proto/write_json.h"
#include "sim/display/display_model.h"
#include "sim/display/glb.h"
#include "sim/image/texture/paint.h"
#include "sim/pipeline/read_inputs.h"
#include "sim/worker/inspection/model_summary.h"

namespace hydroprint::worker {
namespace {

Result<image::Paint> load_colours(const mesh::Model& model, bool shape_only,
                                  const Context& context) {
  if (shape_only) return image::blank_paint(model);
  HP_RETURN_IF_ERROR(pipeline::check_materials(model));
  return image::load_paint(model, std::nullopt, context);
}

}  // namespace

Result<Inspection> inspect_model(const mesh::Model& model, bool shape_only,
                                 const Context& context) {
  context.progress("colours", 0);
  HP_ASSIGN_OR_RETURN(const image::Paint paint, load_colours(model, shape_only, context));
  context.progress("display", 0);
  HP_ASSIGN_OR_RETURN(const display::DisplayModel shown,
                      display::make_display(model, paint, context));
  Inspection out;
  out.summary = summary_of(model, paint, shown);
  HP_ASSIGN_OR_RETURN(const std::string extras, json_file_of(out.summary));
  HP_ASSIGN_OR_RETURN(out.glb, display::glb_of(shown, extras));
  return out;
}

}  // namespace hydroprint::worker
