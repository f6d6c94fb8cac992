#pragma once

#include <map>
#include <memory>
#include <string>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/film/film_texture.h"
#include "sim/image/io/rgb_image.h"
#include "sim/image/texture/paint.h"
#include "sim/ink/ink_field.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/pipeline.h"
#include "sim/validate/validate.h"

namespace hydroprint::validate {

inline constexpr double kFineFactor = 0.6;
/// Factor for all lengths in a quick run.
inline constexpr double kQuickFactor = 2.5;

/// Resolution of a dip's computation.
enum class Fineness {
  kUsual,  ///< the defaults of `simulate`
  kFine,   ///< all lengths times kFineFactor; represents the physical experiment
};

/// A body from the paper and its pose at the start of the dip.
struct Body {
  mesh::Model model;
  image::Paint paint;
  Pose X_FO;
};

/// The result of computing the film image with the usual settings, before the experiment.
struct Plan {
  pipeline::Dip dip;
  image::RgbImage film;  ///< the image to print
  ink::InkField ink;     ///< the ink on the printed film
};

/// Bodies and films, computed on first use and kept for later experiments. By default, dips use the
/// viscous sheet and A4 films.
class ExperimentContext {
 public:
  ExperimentContext(bool quick, PictureSink pictures)
      : quick_(quick), pictures_(std::move(pictures)) {}

  [[nodiscard]] bool quick() const { return quick_; }

  /// Returns a body of sim/sample, oriented as in the paper: "board" tilted by 30 degrees, "bowl"
  /// mouth down, "bowl-upright" upright.
  [[nodiscard]] Result<const Body*> body(const std::string& name, const Context& context);

  /// Returns the options for dipping a body.
  [[nodiscard]] pipeline::DipOptions options(const Body& body, Fineness fineness) const;

  /// Returns the film image for a body, and the dip for which it is computed (two-step scheme, one
  /// ink pass).
  [[nodiscard]] Result<const Plan*> plan(const std::string& name, const Context& context);

  /// Returns the dip of the planned film with the fine settings, which represents reality.
  [[nodiscard]] Result<pipeline::Dip> experiment(const std::string& name, const Context& context);

  /// Returns a film image as a texture, for pictures of the landed film.
  [[nodiscard]] Result<image::FilmTexture> texture(const image::RgbImage& film,
                                                   const Context& context) const;

  /// Passes a picture to the sink as validate-EXPERIMENT-`what`.png, and adds it to the experiment.
  [[nodiscard]] Status show(Experiment& experiment, const std::string& what,
                            const Result<image::RgbImage>& picture,
                            const std::string& caption) const;

  [[nodiscard]] double film_dpi() const { return quick_ ? 75 : 150; }

 private:
  bool quick_;
  PictureSink pictures_;
  std::map<std::string, std::unique_ptr<Body>> bodies_;
  std::map<std::string, std::unique_ptr<Plan>> plans_;
};

/// Computes the film image of a body's texture and its dip, like ExperimentContext::plan, with any
/// options.
/// @param ink_passes  0: the film carries the ink in `options` (by default none: uniform thickness)
[[nodiscard]] Result<Plan> make_plan(const Body& body, const pipeline::DipOptions& options,
                                     int ink_passes, double dpi, const Context& context);

/// Divides the progress of an experiment into steps of equal weight.
class Steps {
 public:
  Steps(const Context& whole, std::string experiment, int count)
      : whole_(whole), experiment_(std::move(experiment)), count_(count) {}

  /// Returns the context of the next step. The stages of a dip count as parts of the step.
  [[nodiscard]] Context next();

 private:
  const Context& whole_;
  std::string experiment_;
  int count_;
  int begun_ = 0;
};

}  // namespace hydroprint::validate
