#pragma once

#include <string>

#include "hydroprint/v1/report.pb.h"
#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/mesh/model.h"

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// A model as it was understood.
struct Inspection {
  v1::ModelSummary summary;
  std::string glb;  ///< for display (display::glb_of), with the summary as extras
};

/// Loads the colours of a model as simulate does, and makes its display. Returns the errors of
/// pipeline::check_materials(), image::load_paint() and display::make_display(). A model without
/// any colour is shown in white.
/// @param shape_only  leave the colours out; missing files that define them are not errors
[[nodiscard]] Result<Inspection> inspect_model(const mesh::Model& model, bool shape_only,
                                               const Context& context);

}  // namespace hydroprint::worker
