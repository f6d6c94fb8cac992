#pragma once

#include <filesystem>
#include <optional>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/film/film_map.h"
#include "sim/image/io/rgb_image.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/pipeline.h"

namespace hydroprint::pipeline {

/// From a textured model to the image to print.
struct SimulateOptions {
  std::filesystem::path mesh;
  double scale = 1;                              ///< model units to mm
  std::optional<std::filesystem::path> texture;  ///< none: the model's own colours
  DipOptions dip;
  double dpi = 300;
  /// Passes of the two-step scheme (section 4.3); 0: as much ink as dip.ink says. For the sheet
  /// alone, and for objects that have a colour.
  int ink_passes = 1;
  bool images = true;  ///< false: where the film lands, and nothing to look at
};

/// What is made to be printed and looked at.
struct SimulatedImages {
  image::RgbImage film;     ///< the image to print
  image::FilmMap film_map;  ///< where the film's points land
  image::RgbImage stretch;  ///< picture of the stretch on the object
  /// Picture of how far the film is gathered; where that makes it wrinkle (film_wrinkled).
  std::optional<image::RgbImage> wrinkles;
  image::RgbImage predicted;  ///< picture of the object as it will look
};

struct Simulation {
  mesh::Model model;
  Dip dip;
  std::optional<SimulatedImages> images;
  Warnings warnings;  ///< of every stage
};

/// The whole chain of section 4: model, paint, dip, film image, pictures.
/// Refuses what its stages refuse and, unless a texture is given, a model whose material file or
/// material is missing (kNotFound): its colours would be white without a word.
[[nodiscard]] Result<Simulation> simulate(const SimulateOptions& options, const Context& context);

}  // namespace hydroprint::pipeline
