#pragma once

#include "hydroprint/v1/report.pb.h"
#include "sim/display/display_model.h"
#include "sim/image/texture/paint.h"
#include "sim/mesh/model.h"

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// States what a model was understood to be.
/// @param paint  its colours
/// @param shown  its display
[[nodiscard]] v1::ModelSummary summary_of(const mesh::Model& model, const image::Paint& paint,
                                          const display::DisplayModel& shown);

}  // namespace hydroprint::worker
