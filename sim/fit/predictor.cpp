#include "sim/fit/predictor.h"

#include <utility>

#include "sim/flow/landing.h"
#include "sim/flow/trace.h"
#include "sim/pipeline/figures.h"

namespace hydroprint::fit {

Result<const pipeline::StokesPass*> Predictor::start(const Eigen::Vector2d& swelling,
                                                     const Context& context) {
  if (!start_ || swelling != swelling_) {
    start_.reset();
    options_.profile.swelling = swelling;
    HP_ASSIGN_OR_RETURN(start_, pipeline::run_stokes_pass(model_, options_, context));
    swelling_ = swelling;
  }
  return &*start_;
}

Result<std::vector<Eigen::Vector2d>> Predictor::predict(const film::Profile& profile,
                                                        const std::vector<Spot>& spots,
                                                        const Context& context) {
  HP_ASSIGN_OR_RETURN(const pipeline::StokesPass* begun, start(profile.swelling, context));
  options_.profile = profile;
  HP_ASSIGN_OR_RETURN(const sheet::SheetFlow moving,
                      pipeline::sheet_field(begun->stokes, options_.ink, options_, context));
  warnings_ = pipeline::warnings_of_motion(static_cast<int>(begun->stokes.fields.size()),
                                           begun->passed_over_mm, moving.unsettled_mm);
  const flow::Landings landings(begun->body, options_.motion);
  std::vector<flow::Landing> at;
  at.reserve(spots.size());
  for (const Spot& spot : spots) at.push_back(landings.on(spot.triangle, spot.barycentric));
  HP_ASSIGN_OR_RETURN(std::vector<Eigen::Vector2d> film_mm,
                      flow::trace_back(moving.field, at, {}, context));
  for (Eigen::Vector2d& p : film_mm) p = p.cwiseQuotient(profile.swelling).eval();
  return film_mm;
}

}  // namespace hydroprint::fit
