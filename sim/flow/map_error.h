#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string_view>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/landing.h"
#include "sim/flow/trace.h"

namespace hydroprint::flow {

/// Indices of landings that are traced together.
using Part = std::vector<std::size_t>;

/// Film points, and how uncertain they are.
struct TracedBack {
  std::vector<Eigen::Vector2d> film_mm;  ///< of trace_back()
  /// Estimate of their error, mm. It ranks the points by their true error, but is not a bound of
  /// it. NaN where no film arrives, or none through every second waterline, and where a landing is
  /// not judged.
  std::vector<double> error_mm;
  std::vector<char> has_torn;  ///< film that was torn at an earlier waterline (DipField::is_torn)
};

/// Traces landings like trace_back(), and also through every second and every fourth waterline, and
/// estimates the error from how the three paths part (README.md). Waterlines beside events are not
/// left out: those whose gaps before and after differ so much that trace_back() restarts there.
/// @param is_judged  for each landing, whether its error is estimated
[[nodiscard]] Result<TracedBack> trace_back_with_error(const DipField& dip,
                                                       const std::vector<Landing>& landings,
                                                       const std::vector<char>& is_judged,
                                                       std::string_view stage,
                                                       const Context& context);

/// Returns immersions at which more waterlines would make some landings more exact: the middles
/// of the gaps in which the paths of a tenth of them through all and through every second waterline
/// part by more than a limit.
/// @param inexact  these landings; at most a few thousand of them decide
/// @return increasing
[[nodiscard]] std::vector<double> depths_to_add(const DipField& dip,
                                                const std::vector<Landing>& landings,
                                                const Part& inexact, double limit_mm);

}  // namespace hydroprint::flow
