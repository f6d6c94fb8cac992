#pragma once

#include <string>
#include <vector>

#include "proto/paint/check_paint.h"
#include "sim/image/layers/layered_paint.h"
#include "sim/pipeline/read_inputs.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/input_folder.h"
#include "sim/worker/common/report.h"

namespace hydroprint::v1 {
class SimulateReport;
}  // namespace hydroprint::v1

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// The paint of an object, and the files that it uses.
struct PaintOptions {
  image::PaintSource source;
  std::vector<InputPath> files;

  [[nodiscard]] bool shows_own_colours() const { return pipeline::needs_own_colours(source); }
};

/// Converts a checked paint. Names of pictures are resolved.
[[nodiscard]] image::PaintSource paint_source_of(const v1::Paint& paint, const InputFolder& inputs);

/// Reads the paint of a spec, or its texture with the short forms. Returns fail_field() for those
/// that paint::check_fields_of() refuses.
/// @param path  of the message that has them: "object", or empty
template <class Spec>
Result<PaintOptions> paint_options(const Spec& spec, const InputFolder& inputs,
                                   const std::string& path = {}) {
  const auto violations = paint::check_fields_of(spec, path);
  if (!violations.empty())
    return fail_field(Code::kInvalidArgument, violations.front().field, violations.front().problem);
  v1::Paint paint = spec.paint();
  if (!spec.has_paint()) *paint.add_layers() = paint::layer_of(spec);
  PaintOptions out;
  out.source = paint_source_of(paint, inputs);
  if (!spec.has_paint() && !out.shows_own_colours())
    out.files.push_back({"texture", inputs.path(spec.texture())});
  if (spec.has_paint()) {
    for (const image::Layer& layer : out.source.layers)
      out.files.push_back({"paint", layer.picture});
  }
  return out;
}

/// Adds the layers to the report, with the defaults filled in.
void add_layers(const std::vector<image::PlacedLayer>& layers, v1::SimulateReport& out);

}  // namespace hydroprint::worker
