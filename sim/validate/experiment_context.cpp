#include "sim/validate/experiment_context.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>
#include <utility>

#include "sim/film/outline.h"
#include "sim/image/figures/pictures.h"
#include "sim/image/film/film_image.h"
#include "sim/ink/ink_of.h"
#include "sim/pipeline/dip.h"
#include "sim/pipeline/ink_passes.h"
#include "sim/sample/sample.h"

namespace hydroprint::validate {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

/// Returns the rotation in which a body is held.
Eigen::AngleAxisd rotation_of(const std::string& name) {
  if (name == "board") return {pi / 6, Vector3d::UnitX()};
  if (name == "bowl") return {pi, Vector3d::UnitX()};
  return {0, Vector3d::UnitX()};
}

Pose centred(const mesh::Model& model, const Eigen::AngleAxisd& rotation) {
  Pose X_FO(rotation);
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : model.vertices) box.extend(X_FO * p);
  X_FO.pretranslate(-box.center());
  return X_FO;
}

}  // namespace

Result<const Body*> ExperimentContext::body(const std::string& name, const Context& context) {
  std::unique_ptr<Body>& kept = bodies_[name];
  if (!kept) {
    auto result = std::make_unique<Body>();
    HP_ASSIGN_OR_RETURN(result->model, sample::make_model(name.substr(0, name.find('-'))));
    HP_ASSIGN_OR_RETURN(result->paint, image::load_paint(result->model, {}, context));
    result->X_FO = centred(result->model, rotation_of(name));
    kept = std::move(result);
  }
  return kept.get();
}

pipeline::DipOptions ExperimentContext::options(const Body& body, Fineness fineness) const {
  pipeline::DipOptions o;
  o.X_FO = body.X_FO;
  o.outline = film::parse_outline("A4").value();
  // A level edge first meets the water as a narrow slit. The narrower the slit, the finer the mesh,
  // so this gap is wider than the default.
  o.schedule.event_gap_mm = 0.05;
  // Fine enough for pictures and for positions to a few hundredths of a millimetre.
  o.map.tolerance_mm = quick_ ? 0.1 : 0.04;
  o.map.least_edge_mm = quick_ ? 0.3 : 0.15;
  const double fine = fineness == Fineness::kFine ? kFineFactor : 1;
  return pipeline::scaled_resolution(std::move(o), fine * (quick_ ? kQuickFactor : 1));
}

Result<Plan> make_plan(const Body& body, const pipeline::DipOptions& options, int ink_passes,
                       double dpi, const Context& context) {
  Plan plan;
  if (ink_passes == 0) {
    HP_ASSIGN_OR_RETURN(plan.dip, pipeline::dip(body.model, options, context));
  } else {
    HP_ASSIGN_OR_RETURN(pipeline::StokesPass begun,
                        pipeline::run_stokes_pass(body.model, options, context));
    HP_ASSIGN_OR_RETURN(
        plan.dip, pipeline::dip_inked(body.model, std::move(begun),
                                      pipeline::drawing_of(body.paint, options.outline), ink_passes,
                                      dpi, options, context));
  }
  HP_ASSIGN_OR_RETURN(plan.film, image::film_image(plan.dip.surface, plan.dip.map.tiles, body.paint,
                                                   options.outline, dpi, context));
  HP_ASSIGN_OR_RETURN(plan.ink, ink::ink_of(plan.film, options.outline,
                                            {options.profile.ink_icc_profile}, context));
  return plan;
}

Result<const Plan*> ExperimentContext::plan(const std::string& name, const Context& context) {
  std::unique_ptr<Plan>& kept = plans_[name];
  if (!kept) {
    HP_ASSIGN_OR_RETURN(const Body* held, body(name, context));
    HP_ASSIGN_OR_RETURN(Plan result,
                        make_plan(*held, options(*held, Fineness::kUsual), 1, film_dpi(), context));
    kept = std::make_unique<Plan>(std::move(result));
  }
  return kept.get();
}

Result<pipeline::Dip> ExperimentContext::experiment(const std::string& name,
                                                    const Context& context) {
  HP_ASSIGN_OR_RETURN(const Body* held, body(name, context));
  HP_ASSIGN_OR_RETURN(const Plan* planned, plan(name, context));
  pipeline::DipOptions fine = options(*held, Fineness::kFine);
  fine.ink = planned->ink;
  return pipeline::dip(held->model, fine, context);
}

Result<image::FilmTexture> ExperimentContext::texture(const image::RgbImage& film,
                                                      const Context& context) const {
  return image::FilmTexture::from_image(film, film::parse_outline("A4").value(),
                                        image::kPictureFilmSide_px, context);
}

Status ExperimentContext::show(Experiment& experiment, const std::string& what,
                               const Result<image::RgbImage>& picture,
                               const std::string& caption) const {
  if (!picture) return tl::unexpected(picture.error());
  const std::string file = "validate-" + experiment.name + "-" + what + ".png";
  experiment.pictures.push_back({file, caption, picture->width, picture->height});
  return pictures_(file, *picture);
}

Context Steps::next() {
  const int step = begun_++;
  Context context = whole_;
  context.report = [this, step](std::string_view stage, double fraction) {
    // Rough fractions of a dip's duration at which its stages begin and end. A repeated stage does
    // not change the total.
    struct Share {
      std::string_view stage;
      double begin, end;
    };
    constexpr std::array<Share, 6> kShares = {{{"surface", 0, 0.02},
                                               {"waterline", 0.02, 0.1},
                                               {"velocity", 0.1, 0.3},
                                               {"sheet", 0.3, 0.75},
                                               {"flow map", 0.75, 0.95},
                                               {"film image", 0.95, 1}}};
    for (const Share& share : kShares) {
      if (share.stage != stage) continue;
      const double done = share.begin + (share.end - share.begin) * std::clamp(fraction, 0.0, 1.0);
      whole_.progress(experiment_, std::min(1.0, (step + done) / count_));
    }
  };
  whole_.progress(experiment_, std::min(1.0, static_cast<double>(step) / count_));
  return context;
}

}  // namespace hydroprint::validate
