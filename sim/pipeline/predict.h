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
  double scale = 1;                  ///< model units to mm
  std::filesystem::path film_image;  ///< any image at the film's size
  DipOptions dip;                    ///< the true pose, and the path as driven
  int ink_passes = 1;  ///< not 0: the film carries the ink of film_image, else that of dip.ink
  bool images = true;  ///< false: only the film's landing, without images
};

/// The colours that land on the object.
struct PredictedImages {
  std::vector<Eigen::Vector3f> landed;      ///< per point of the surface; NaN: no film arrives
  std::optional<image::RgbaImage> texture;  ///< the same as a texture; nullopt: no UVs
  image::RgbImage picture;                  ///< of the object
};

struct Prediction {
  mesh::Model model;
  Dip dip;
  std::optional<PredictedImages> images;
  Warnings warnings;  ///< of every stage
};

/// The chain of section 4 in reverse: film image, model, dip, colours, pictures. Fails as its
/// stages do.
[[nodiscard]] Result<Prediction> predict(const PredictOptions& options, const Context& context);

}  // namespace hydroprint::pipeline
