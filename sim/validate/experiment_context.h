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
/// By which all lengths are longer in a quick run.
inline constexpr double kQuickFactor = 2.5;

/// How finely a dip is computed.
enum class Fineness {
  kUsual,  ///< as `simulate` does unless told otherwise
  kFine,   ///< all lengths times kFineFactor: what plays the physical experiment
};

/// A body of the paper and how the gripper holds it.
struct Body {
  mesh::Model model;
  image::Paint paint;
  Pose X_FO;
};

/// What the computation at its usual settings gives out before the experiment.
struct Plan {
  pipeline::Dip dip;
  image::RgbImage film;  ///< to print
  ink::InkField ink;     ///< that the printed film carries
};

/// Bodies and films, made when first asked for and kept for the experiments that follow.
/// All dips are of viscous sheets in A4 films unless their options are changed.
class ExperimentContext {
 public:
  ExperimentContext(bool quick, PictureSink pictures)
      : quick_(quick), pictures_(std::move(pictures)) {}

  [[nodiscard]] bool quick() const { return quick_; }

  /// One of sim/sample, held as in the paper: "board" tilted by 30 degrees, "bowl" mouth down,
  /// "bowl-upright" as it stands.
  [[nodiscard]] Result<const Body*> body(const std::string& name, const Context& context);

  /// How to dip a body.
  [[nodiscard]] pipeline::DipOptions options(const Body& body, Fineness fineness) const;

  /// The film image for a body and where it is thought to land (two-step scheme, one ink pass).
  [[nodiscard]] Result<const Plan*> plan(const std::string& name, const Context& context);

  /// `predict` at the fine settings: where that film lands "in truth".
  [[nodiscard]] Result<pipeline::Dip> experiment(const std::string& name, const Context& context);

  /// A film image, for pictures of what lands.
  [[nodiscard]] Result<image::FilmTexture> texture(const image::RgbImage& film,
                                                   const Context& context) const;

  /// Hands a picture over and enters it into the experiment's list, as
  /// validate-EXPERIMENT-`what`.png.
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

/// The film image of a body's texture and its dip, for any options: as ExperimentContext::plan.
/// @param ink_passes  0: the film is taken to be equally thick everywhere
[[nodiscard]] Result<Plan> make_plan(const Body& body, const pipeline::DipOptions& options,
                                     int ink_passes, double dpi, const Context& context);

/// Divides the progress of an experiment into steps of equal weight.
class Steps {
 public:
  Steps(const Context& whole, std::string experiment, int count)
      : whole_(whole), experiment_(std::move(experiment)), count_(count) {}

  /// The context of the next step: the stages of a dip count as parts of it.
  [[nodiscard]] Context next();

 private:
  const Context& whole_;
  std::string experiment_;
  int count_;
  int begun_ = 0;
};

}  // namespace hydroprint::validate
