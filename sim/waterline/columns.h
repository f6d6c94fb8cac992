#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/waterline/body.h"

namespace hydroprint::waterline {

/// Vertical lines through a body, and where they run inside of it: in the union of its shells
/// without its cavities, computed without slicing it. A shell is a part that shares no edge with
/// others. Where all edges of a shell have two faces, its inside is where a line has entered it
/// more often than left it (or the reverse, for cavities). Otherwise a line enters and leaves the
/// shell in turn. The lines stand on a square grid that is turned, so that walls along x and y are
/// sampled evenly.
class Columns {
 public:
  /// A part of a line inside the body.
  struct Span {
    double from_mm = 0, to_mm = 0;  ///< immersions
  };
  static constexpr int kAcross = 200;  ///< lines in each direction of the grid
  static constexpr int kSamples = 4;   ///< interleaved grids, for estimating the error

  explicit Columns(const Body& body);

  [[nodiscard]] std::size_t size() const { return start_.size() - 1; }
  [[nodiscard]] Eigen::Vector2d place_mm(std::size_t column) const;
  [[nodiscard]] std::span<const Span> spans(std::size_t column) const {
    return std::span(spans_).subspan(start_[column], start_[column + 1] - start_[column]);
  }
  [[nodiscard]] double cell_mm2() const { return cell_mm_ * cell_mm_; }
  /// Returns the interleaved grid that the line belongs to, below kSamples.
  [[nodiscard]] static int sample_of(std::size_t column) {
    return static_cast<int>(column % kAcross % 2 + column / kAcross % 2 * 2);
  }

 private:
  Eigen::Vector2d middle_mm_ = Eigen::Vector2d::Zero();
  double cell_mm_ = 0;
  std::vector<std::size_t> start_;
  std::vector<Span> spans_;
};

}  // namespace hydroprint::waterline
