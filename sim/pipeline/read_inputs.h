#pragma once

#include <filesystem>
#include <optional>

#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/image/layers/layered_paint.h"
#include "sim/mesh/model.h"

namespace hydroprint::pipeline {

/// The model to read, and what it is needed for.
struct ModelInput {
  std::filesystem::path mesh;
  double scale = 1;        ///< millimetres per model unit
  bool has_paint = false;  ///< pictures are given, so the model's own colours are not needed
  bool images = true;      ///< pictures will be drawn
};

/// Returns the paint that a texture stands for: one layer with that picture, or without a texture
/// one with the model's own colours. A given paint is returned unchanged.
[[nodiscard]] image::PaintSource paint_source(const std::optional<image::PaintSource>& paint,
                                              const std::optional<std::filesystem::path>& texture);

/// Returns whether a layer of the paint shows the model's own colours.
[[nodiscard]] bool needs_own_colours(const image::PaintSource& paint);

/// Reads a model and, if pictures will be needed, loads the image libraries at the same time.
/// Returns the errors of mesh::read_model(), and if no picture is given those of check_materials().
[[nodiscard]] Result<mesh::Model> read_inputs(const ModelInput& input, const Context& context);

/// Returns kNotFound for a model whose faces would be white because its material file, or a
/// material in it, is missing.
[[nodiscard]] Status check_materials(const mesh::Model& model);

/// Loads a model's paint for a film image. Returns the errors of image::load_layers(), and
/// kInvalidArgument for a paint or model without any colour that was understood, because the film
/// would stay blank; the message says what was found and not understood.
/// @param X_FO  see DipOptions
[[nodiscard]] Result<image::LayeredPaint> read_paint(const mesh::Model& model,
                                                     const image::PaintSource& source,
                                                     const std::optional<Pose>& X_FO,
                                                     const Context& context);

/// Same as above, but accepts a paint without colours.
[[nodiscard]] Result<image::LayeredPaint> read_any_paint(const mesh::Model& model,
                                                         const image::PaintSource& source,
                                                         const std::optional<Pose>& X_FO,
                                                         const Context& context);

}  // namespace hydroprint::pipeline
