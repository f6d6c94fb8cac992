#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/film/landed.h"
#include "sim/image/io/rgb_image.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/pipeline.h"

namespace hydroprint::pipeline {

/// Options for predicting the look of the object from a printed film image.
struct PredictOptions {
  std::filesystem::path mesh;
  double scale = 1;                  ///< millimetres per model unit
  std::filesystem::path film_image;  ///< covers the film; any resolution
  DipOptions dip;                    ///< options of the dip, with the measured pose and path
  int ink_passes = 1;  ///< 0: the film carries the ink of dip.ink, otherwise that of film_image
  bool images = true;  ///< false: computes only the film's landing, without images
};

/// The colours that land on the object.
struct PredictedImages {
  /// Colour of each point of the surface; NaN: no film arrives.
  std::vector<Eigen::Vector3f> landed;
  std::optional<image::RgbaImage> texture;  ///< the same colours; nullopt: the model has no UVs
  image::RgbImage picture;                  ///< picture of the object
};

struct Prediction {
  mesh::Model model;
  Dip dip;
  std::optional<PredictedImages> images;
  Warnings warnings;  ///< warnings of all stages
};

/// Runs the steps of section 4 from a film image to the colours on the object: film image, model,
/// dip, colours, pictures. Returns the errors of its stages.
[[nodiscard]] Result<Prediction> predict(const PredictOptions& options, const Context& context);

}  // namespace hydroprint::pipeline
