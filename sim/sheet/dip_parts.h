#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "sim/flow/trace.h"
#include "sim/velocity/velocity.h"

namespace hydroprint::sheet {

/// Returns the prescribed velocity of each node at the film's edges; NaN for all other nodes.
[[nodiscard]] std::vector<Eigen::Vector2d> prescribed(const velocity::VelocityField& field);

/// Returns the length of dip that waterline `k` represents, in mm: between the midpoints to its two
/// neighbours.
[[nodiscard]] double span_mm(const flow::DipField& dip, std::size_t k);

/// Returns the root mean square of the difference between two lists of vectors.
[[nodiscard]] double rms_change(const std::vector<Eigen::Vector2d>& a,
                                const std::vector<Eigen::Vector2d>& b);

}  // namespace hydroprint::sheet
