#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/simulate.h"

namespace hydroprint::pipeline {

/// Reads the model of a simulation and, if pictures will be needed, loads the image libraries at
/// the same time. Returns the errors of mesh::read_model(). If no texture is given, also returns
/// kNotFound for a model whose material file or material is missing.
[[nodiscard]] Result<mesh::Model> read_inputs(const SimulateOptions& options,
                                              const Context& context);

}  // namespace hydroprint::pipeline
