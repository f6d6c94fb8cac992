#pragma once

#include <filesystem>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/mesh/model.h"

namespace hydroprint::pipeline {

/// The model to read, and what it is needed for.
struct ModelInput {
  std::filesystem::path mesh;
  double scale = 1;          ///< millimetres per model unit
  bool has_texture = false;  ///< a texture is given, so the model's own colours are not needed
  bool images = true;        ///< pictures will be drawn
};

/// Reads a model and, if pictures will be needed, loads the image libraries at the same time.
/// Returns the errors of mesh::read_model(). If no texture is given, also returns kNotFound for a
/// model whose material file or material is missing.
[[nodiscard]] Result<mesh::Model> read_inputs(const ModelInput& input, const Context& context);

}  // namespace hydroprint::pipeline
