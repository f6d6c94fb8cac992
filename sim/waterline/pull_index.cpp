#include "sim/waterline/pull_index.h"

#include <algorithm>
#include <limits>

namespace hydroprint::waterline {
namespace {

constexpr double kCell_mm = 1.5;

struct Nearest {
  double square_mm2 = std::numeric_limits<double>::infinity();
  Eigen::Vector2d pull = Eigen::Vector2d::Zero();
};

void consider(const Segment& s, const Eigen::Vector2d& p, Nearest& nearest) {
  const Eigen::Vector2d along = s.b_mm - s.a_mm;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - s.a_mm).dot(along) / length2, 0.0, 1.0) : 0.0;
  const double square = (s.a_mm + t * along - p).squaredNorm();
  if (square < nearest.square_mm2) nearest = {square, (1 - t) * s.pull_a + t * s.pull_b};
}

}  // namespace

PullIndex::PullIndex(const std::vector<Contour>& contours) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (const Contour& contour : contours) {
    for (const Segment& s : contour) {
      segments_.push_back(s);
      low = low.cwiseMin(s.a_mm).cwiseMin(s.b_mm);
      high = high.cwiseMax(s.a_mm).cwiseMax(s.b_mm);
    }
  }
  if (segments_.empty()) return;
  origin_mm_ = low;
  cells_ = ((high - low) / kCell_mm).cast<int>().array() + 1;

  const auto for_cells = [&](const Segment& s, auto&& visit) {
    const Eigen::Vector2i first = cell_of(s.a_mm.cwiseMin(s.b_mm));
    const Eigen::Vector2i last = cell_of(s.a_mm.cwiseMax(s.b_mm));
    for (int y = first.y(); y <= last.y(); ++y) {
      for (int x = first.x(); x <= last.x(); ++x) visit(y * cells_.x() + x);
    }
  };
  cell_start_.assign(static_cast<std::size_t>(cells_.prod()) + 1, 0);
  for (const Segment& s : segments_) for_cells(s, [&](int cell) { ++cell_start_[cell + 1]; });
  for (std::size_t c = 1; c < cell_start_.size(); ++c) cell_start_[c] += cell_start_[c - 1];
  cell_segments_.resize(cell_start_.back());
  std::vector<int> next(cell_start_.begin(), cell_start_.end() - 1);
  for (int i = 0; i < static_cast<int>(segments_.size()); ++i) {
    for_cells(segments_[i], [&](int cell) { cell_segments_[next[cell]++] = i; });
  }
}

Eigen::Vector2i PullIndex::cell_of(const Eigen::Vector2d& point_mm) const {
  const Eigen::Vector2d cell = (point_mm - origin_mm_) / kCell_mm;
  return {static_cast<int>(std::clamp(cell.x(), 0.0, cells_.x() - 1.0)),
          static_cast<int>(std::clamp(cell.y(), 0.0, cells_.y() - 1.0))};
}

Eigen::Vector2d PullIndex::at(const Eigen::Vector2d& point_mm) const {
  if (segments_.empty()) return Eigen::Vector2d::Zero();
  const Eigen::Vector2i centre = cell_of(point_mm);
  Nearest nearest;
  // Searches rings of cells outward until no ring can contain a nearer segment.
  const int rings = cells_.maxCoeff();
  for (int ring = 0; ring <= rings; ++ring) {
    const double reach_mm = (ring - 1) * kCell_mm;
    if (ring > 1 && nearest.square_mm2 <= reach_mm * reach_mm) break;
    for (int y = std::max(0, centre.y() - ring); y <= std::min(cells_.y() - 1, centre.y() + ring);
         ++y) {
      const bool whole_row = y == centre.y() - ring || y == centre.y() + ring;
      for (int x = centre.x() - ring; x <= centre.x() + ring;
           x += whole_row || ring == 0 ? 1 : 2 * ring) {
        if (x < 0 || x >= cells_.x()) continue;
        const int cell = y * cells_.x() + x;
        for (int i = cell_start_[cell]; i < cell_start_[cell + 1]; ++i) {
          consider(segments_[cell_segments_[i]], point_mm, nearest);
        }
      }
    }
  }
  return nearest.pull;
}

}  // namespace hydroprint::waterline
