#include "sim/waterline/contours.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace hydroprint::waterline {
namespace {

namespace bg = boost::geometry;
using Entry = std::pair<bg::model::d2::point_xy<double>, int>;  ///< an end of a segment
using Tree = bg::index::rtree<Entry, bg::index::rstar<16>>;

constexpr double kUnlimited_mm = std::numeric_limits<double>::infinity();
/// Open ends are closed within 5 mm, nearest ends first, and only then over any distance.
constexpr double kRadii_mm[] = {0, 0.01, 0.1, 1, 5, kUnlimited_mm};

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

/// Follows the links from `end` around their cycle; marks its segments as seen. Where linked ends
/// are apart, a straight line closes the gap.
Contour follow(const std::vector<CutSegment>& cuts, const std::vector<int>& link, int end,
               std::vector<char>& seen) {
  std::vector<int> entries;
  double forward_mm = 0;
  for (int at = end; !seen[segment_of(at)]; at = link[opposite(at)]) {
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
    const Segment turned = is_start(entry) ? s : reversed(s);
    if (!contour.empty()) bridge(contour, turned);
    contour.push_back(turned);
  }
  bridge(contour, contour.front());
  return contour;
}

/// Links the ends that have no link to the nearest other one within the radius. The two ends of one
/// segment are only linked if the radius is unlimited.
/// @param with_direction  links only ends of segments with starts
void link_near(const std::vector<CutSegment>& cuts, double radius_mm, bool with_direction,
               std::vector<int>& link) {
  const auto entry = [&](int end) -> Entry {
    const Segment& s = cuts[segment_of(end)].segment;
    const Eigen::Vector2d& p = is_start(end) ? s.a_mm : s.b_mm;
    return {{p.x(), p.y()}, end};
  };
  std::vector<Entry> sources, targets;
  for (int end = 0; end < static_cast<int>(link.size()); ++end) {
    if (link[end] != kNone) continue;
    if (!with_direction || !is_start(end)) sources.push_back(entry(end));
    if (!with_direction || is_start(end)) targets.push_back(entry(end));
  }
  Tree tree(targets);
  for (const Entry& source : sources) {
    const auto& [place, end] = source;
    if (link[end] != kNone) continue;
    if (!with_direction) tree.remove(source);
    const auto is_allowed = [&, end = end](const Entry& target) {
      return target.second != opposite(end) || radius_mm == kUnlimited_mm;
    };
    const auto nearest =
        tree.qbegin(bg::index::nearest(place, 1) && bg::index::satisfies(is_allowed));
    if (nearest == tree.qend() || bg::distance(place, nearest->first) > radius_mm) continue;
    const Entry target = *nearest;
    link[end] = target.second;
    link[target.second] = end;
    tree.remove(target);
  }
}

}  // namespace

std::vector<Contour> join(const std::vector<CutSegment>& cuts) {
  std::vector<int> link = link_ends(cuts);
  for (const double radius_mm : kRadii_mm) {
    if (std::find(link.begin(), link.end(), kNone) == link.end()) break;
    for (const bool with_direction : {true, false}) {
      link_near(cuts, radius_mm, with_direction, link);
    }
  }
  std::vector<char> seen(cuts.size(), 0);
  std::vector<Contour> contours;
  for (int s = 0; s < static_cast<int>(cuts.size()); ++s) {
    if (!seen[s]) contours.push_back(follow(cuts, link, 2 * s, seen));
  }
  return contours;
}

}  // namespace hydroprint::waterline
