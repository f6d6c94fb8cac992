#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/fit/spots.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/stokes_pass.h"

namespace hydroprint::fit {

/// Predicts, for a profile, which printed points of the film land on given spots of a body.
/// Simulates the dip with the sheet model, then traces the film back from these spots only.
class Predictor {
 public:
  /// @param model    must outlive the predictor
  /// @param options  options of the dip; predict() replaces the profile
  Predictor(const mesh::Model& model, pipeline::DipOptions options)
      : model_(model), options_(std::move(options)) {}

  /// Returns the first pass of the dip, which does not depend on ink and drag. Cached for the
  /// latest swelling.
  [[nodiscard]] Result<const pipeline::StokesPass*> start(const Eigen::Vector2d& swelling,
                                                          const Context& context);

  /// Returns the printed point for each spot, mm, in F; NaN where no film arrives.
  [[nodiscard]] Result<std::vector<Eigen::Vector2d>> predict(const film::Profile& profile,
                                                             const std::vector<Spot>& spots,
                                                             const Context& context);

  /// Returns reasons not to trust the motion of the last prediction (pipeline::warnings_of_motion).
  [[nodiscard]] const Warnings& warnings() const { return warnings_; }

 private:
  const mesh::Model& model_;
  pipeline::DipOptions options_;
  std::optional<pipeline::StokesPass> start_;
  Warnings warnings_;
  Eigen::Vector2d swelling_ = Eigen::Vector2d::Zero();  ///< the swelling of start_
};

}  // namespace hydroprint::fit
