#include "sim/waterline/contours.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hydroprint::waterline {
namespace {

// A segment's start is encoded as 2 * segment, its end as 2 * segment + 1.
constexpr int kNone = -1;
int segment_of(int end) { return end / 2; }
int opposite(int end) { return end ^ 1; }
bool is_start(int end) { return end % 2 == 0; }

/// Returns, for each end of a segment, the end that it meets on the same mesh edge; kNone at a
/// boundary of the surface.
std::vector<int> link_ends(const std::vector<CutSegment>& cuts) {
  struct End {
    std::uint64_t edge;
    int end;
  };
  std::vector<End> ends;
  ends.reserve(2 * cuts.size());
  for (int s = 0; s < static_cast<int>(cuts.size()); ++s) {
    ends.push_back({cuts[s].edge_a, 2 * s});
    ends.push_back({cuts[s].edge_b, 2 * s + 1});
  }
  std::sort(ends.begin(), ends.end(), [](const End& x, const End& y) {
    return x.edge != y.edge ? x.edge < y.edge : x.end < y.end;
  });
  std::vector<int> link(ends.size(), kNone);
  const auto join_two = [&](int x, int y) {
    link[x] = y;
    link[y] = x;
  };
  std::vector<int> starts, finishes;
  for (std::size_t i = 0; i < ends.size();) {
    starts.clear();
    finishes.clear();
    const std::uint64_t edge = ends[i].edge;
    for (; i < ends.size() && ends[i].edge == edge; ++i) {
      (is_start(ends[i].end) ? starts : finishes).push_back(ends[i].end);
    }
    // First pairs ends with starts, then the remaining ones with each other (if faces are inside
    // out).
    const std::size_t pairs = std::min(starts.size(), finishes.size());
    for (std::size_t k = 0; k < pairs; ++k) join_two(starts[k], finishes[k]);
    auto& rest = starts.size() > pairs ? starts : finishes;
    for (std::size_t k = pairs; k + 1 < rest.size(); k += 2) join_two(rest[k], rest[k + 1]);
  }
  return link;
}

Segment reversed(const Segment& s) {
  // Reversing a face reverses its normal. The pull therefore changes its direction, and theta
  // becomes pi - theta, whose half-angle tangent is the reciprocal.
  const auto turned = [](const Eigen::Vector2d& pull) -> Eigen::Vector2d {
    const double square = pull.squaredNorm();
    static const double limit = std::tan(0.5 * kThetaLimit_rad);
    if (square * limit * limit <= 1) return -pull.normalized() * (square > 0 ? limit : 0);
    return -pull / square;
  };
  return {s.b_mm, s.a_mm, turned(s.pull_b), turned(s.pull_a)};
}

/// Follows the chain from `end` until it closes or ends; marks its segments as seen.
Contour follow(const std::vector<CutSegment>& cuts, const std::vector<int>& link, int end,
               std::vector<char>& seen) {
  std::vector<int> entries;
  double forward_mm = 0;
  for (int at = end; at != kNone && !seen[segment_of(at)]; at = link[opposite(at)]) {
    seen[segment_of(at)] = 1;
    entries.push_back(at);
    const Segment& s = cuts[segment_of(at)].segment;
    forward_mm += (s.b_mm - s.a_mm).norm() * (is_start(at) ? 1 : -1);
  }
  if (forward_mm < 0) {  // most of its length runs the other way
    std::reverse(entries.begin(), entries.end());
    for (int& entry : entries) entry = opposite(entry);
  }
  Contour contour;
  contour.reserve(entries.size());
  for (const int entry : entries) {
    const Segment& s = cuts[segment_of(entry)].segment;
    contour.push_back(is_start(entry) ? s : reversed(s));
  }
  return contour;
}

/// Appends a straight line to `target`, in pieces of at most 1 mm. The pull is interpolated
/// linearly.
void bridge(Contour& contour, const Segment& target) {
  // Copies, because the last segment and `target` may be elements of the growing contour.
  const Segment from = contour.back();
  const Segment to = target;
  const double length_mm = (to.a_mm - from.b_mm).norm();
  if (length_mm == 0) return;
  const int pieces = static_cast<int>(std::ceil(length_mm));
  const auto point = [&](int i) -> Eigen::Vector2d {
    return from.b_mm + (to.a_mm - from.b_mm) * i / pieces;
  };
  const auto pull_at = [&](int i) -> Eigen::Vector2d {
    return from.pull_b + (to.pull_a - from.pull_b) * i / pieces;
  };
  for (int i = 0; i < pieces; ++i) {
    contour.push_back({point(i), point(i + 1), pull_at(i), pull_at(i + 1)});
  }
}

/// Joins open chains: each end to the nearest remaining start, which may be its own.
void close_up(std::vector<Contour> open, std::vector<Contour>& closed) {
  while (!open.empty()) {
    Contour contour = std::move(open.back());
    open.pop_back();
    while (true) {
      const Eigen::Vector2d end = contour.back().b_mm;
      double best = (contour.front().a_mm - end).squaredNorm();
      auto next = open.end();
      for (auto it = open.begin(); it != open.end(); ++it) {
        const double distance = (it->front().a_mm - end).squaredNorm();
        if (distance < best) {
          best = distance;
          next = it;
        }
      }
      if (next == open.end()) break;
      bridge(contour, next->front());
      contour.insert(contour.end(), next->begin(), next->end());
      open.erase(next);
    }
    bridge(contour, contour.front());
    closed.push_back(std::move(contour));
  }
}

}  // namespace

std::vector<Contour> join(const std::vector<CutSegment>& cuts) {
  const std::vector<int> link = link_ends(cuts);
  std::vector<char> seen(cuts.size(), 0);
  std::vector<Contour> open, closed;
  for (int end = 0; end < static_cast<int>(link.size()); ++end) {
    if (link[end] == kNone && !seen[segment_of(end)]) open.push_back(follow(cuts, link, end, seen));
  }
  for (int s = 0; s < static_cast<int>(cuts.size()); ++s) {
    if (!seen[s]) closed.push_back(follow(cuts, link, 2 * s, seen));
  }
  close_up(std::move(open), closed);
  return closed;
}

}  // namespace hydroprint::waterline
