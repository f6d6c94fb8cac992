#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/film/film_map.h"
#include "sim/image/io/rgb_image.h"
#include "sim/image/layers/layered_paint.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/plan_share.h"

namespace hydroprint::pipeline {

/// Options for computing the image to print from a textured model.
struct SimulateOptions {
  std::filesystem::path mesh;
  double scale = 1;                              ///< millimetres per model unit
  std::optional<std::filesystem::path> texture;  ///< nullopt: the model's own colours
  std::optional<image::PaintSource> paint;       ///< instead of `texture`
  DipOptions dip;
  double dpi = 300;
  /// Number of passes of the two-step scheme (section 4.3); 0: uses the ink in dip.ink. Only for
  /// the sheet, and for objects with colours.
  int ink_passes = 1;
  bool images = true;        ///< false: computes only the film's landing, without images
  bool needs_colour = true;  ///< false: a model without colours is accepted, and its film blank
  /// One dip of a plan: the film prints only what the plan gives it. nullopt: everything.
  std::optional<PlanShare> share;
};

/// The image to print, and pictures for display.
struct SimulatedImages {
  image::RgbImage film;  ///< the image to print
  /// Only for one dip of a plan; see DipImages.
  std::optional<image::RgbImage> complete, mask;
  image::FilmMap film_map;  ///< landing points of the film
  image::RgbImage stretch;  ///< picture of the stretch on the object
  image::RgbImage error;    ///< picture of the stated error on the object
  /// Picture of the film's compression; present only if the film wrinkles (film_wrinkled).
  std::optional<image::RgbImage> wrinkles;
  image::RgbImage predicted;  ///< picture of the object with its predicted look
};

struct Simulation {
  mesh::Model model;
  Dip dip;
  std::optional<SimulatedImages> images;
  std::vector<image::PlacedLayer> layers;  ///< of the paint; empty without images
  std::optional<PlanDeviation> deviation;  ///< only for one dip of a plan
  Warnings warnings;                       ///< warnings of all stages
};

/// Runs all steps of section 4: model, paint, dip, film image, pictures. Returns the errors of its
/// stages. If no picture is given, also returns kNotFound for a model whose material file or
/// material is missing, because its colours would silently be white. Returns the errors of
/// read_paint() unless `needs_colour` or `images` is false, and for one dip of a plan those of
/// divide_as_planned().
[[nodiscard]] Result<Simulation> simulate(const SimulateOptions& options, const Context& context);

}  // namespace hydroprint::pipeline
