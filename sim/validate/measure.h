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

/// A set of numbers in figures; all but `count` are NaN if there are none.
struct Summary {
  std::size_t count = 0;
  double mean = 0, rms = 0, p50 = 0, p95 = 0, max = 0;
};

/// Of those that are finite.
[[nodiscard]] Summary summarise(std::vector<double> values);

/// Per point of the surface: how far from it the film printed for it lands in the experiment, mm,
/// straight through space; NaN where the plan prints nothing for it, infinite where what is printed
/// lands nowhere. The two dips must be of the same surface.
[[nodiscard]] Result<std::vector<double>> landing_errors(const pipeline::Dip& plan,
                                                         const pipeline::Dip& experiment,
                                                         const Context& context);

/// Per point of the surface: how far apart on the film two dips find what lands there; NaN where
/// one of them finds none.
[[nodiscard]] std::vector<double> film_differences(const pipeline::Dip& a, const pipeline::Dip& b);

/// A part of a body, by place, in O.
using Region = std::function<bool(const Eigen::Vector3d&)>;
[[nodiscard]] inline bool everywhere(const Eigen::Vector3d&) { return true; }

/// The values of a region's points, those at one place once.
[[nodiscard]] std::vector<double> values_where(const mesh::Surface& surface,
                                               const std::vector<double>& values,
                                               const Region& region);

/// The share, by area, of a region's points for which something holds; 0 if it is empty.
[[nodiscard]] double share_where(const mesh::Surface& surface, const Region& region,
                                 const std::function<bool(std::size_t point)>& holds);

/// A picture's quantity from one value per point of the surface, at points without one the mean of
/// their neighbours'. Its scale fits a region.
[[nodiscard]] image::Quantity quantity_of(const std::string& label, const mesh::Surface& surface,
                                          const std::vector<double>& values,
                                          const Region& fits = everywhere);

/// With so many digits behind the point; "-" if it is not finite.
[[nodiscard]] std::string text_of(double value, int digits);

}  // namespace hydroprint::validate
