#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/figures/pictures.h"
#include "sim/mesh/surface.h"
#include "sim/pipeline/pipeline.h"

namespace hydroprint::validate {

/// Statistics of a set of numbers. All except `count` are NaN if the set is empty.
struct Summary {
  std::size_t count = 0;
  double mean = 0, rms = 0, p50 = 0, p95 = 0, max = 0;
};

/// Computes the statistics of the finite values.
[[nodiscard]] Summary summarise(std::vector<double> values);

/// Computes for each point of the surface the straight distance in mm to the place where the film
/// printed for it lands in the experiment. NaN if the plan prints nothing for the point, infinite
/// if the printed film does not land. The two dips must be of the same surface.
[[nodiscard]] Result<std::vector<double>> landing_errors(const pipeline::Dip& plan,
                                                         const pipeline::Dip& experiment,
                                                         const Context& context);

/// Computes for each point of the surface the distance on the film between the points that land
/// there in two dips; NaN if no film lands there in one of the dips.
[[nodiscard]] std::vector<double> film_differences(const pipeline::Dip& a, const pipeline::Dip& b);

/// A part of a body, as a predicate on positions in the object frame O.
using Region = std::function<bool(const Eigen::Vector3d&)>;
[[nodiscard]] inline bool everywhere(const Eigen::Vector3d&) { return true; }

/// Returns the values at a region's points. Welded points count once.
[[nodiscard]] std::vector<double> values_where(const mesh::Surface& surface,
                                               const std::vector<double>& values,
                                               const Region& region);

/// Returns the fraction, by area, of a region's points for which `holds` is true; 0 if the region
/// is empty.
[[nodiscard]] double share_where(const mesh::Surface& surface, const Region& region,
                                 const std::function<bool(std::size_t point)>& holds);

/// Creates a quantity for a picture from one value for each point of the surface. Missing values
/// are replaced with the mean over their triangle. The scale covers the values in the region
/// `fits`.
[[nodiscard]] image::Quantity quantity_of(const std::string& label, const mesh::Surface& surface,
                                          const std::vector<double>& values,
                                          const Region& fits = everywhere);

/// Formats a number with `digits` decimal places; "-" if it is not finite.
[[nodiscard]] std::string text_of(double value, int digits);

}  // namespace hydroprint::validate
