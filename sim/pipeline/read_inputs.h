#pragma once

#include <filesystem>
#include <optional>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/texture/paint.h"
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

/// Loads a model's colours for a film image. Returns the errors of image::load_paint(), and
/// kInvalidArgument for a model without any colour that was understood, because its film would stay
/// blank; the message says what was found and not understood.
[[nodiscard]] Result<image::Paint> read_paint(const mesh::Model& model,
                                              const std::optional<std::filesystem::path>& texture,
                                              const Context& context);

}  // namespace hydroprint::pipeline
