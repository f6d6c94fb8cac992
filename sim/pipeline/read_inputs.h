#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/simulate.h"

namespace hydroprint::pipeline {

/// Reads the model of a simulation and, if pictures will be needed, loads the image libraries
/// meanwhile. Refuses what mesh::read_model refuses and, unless a texture is given, a model whose
/// material file or material is missing (kNotFound).
[[nodiscard]] Result<mesh::Model> read_inputs(const SimulateOptions& options,
                                              const Context& context);

}  // namespace hydroprint::pipeline
